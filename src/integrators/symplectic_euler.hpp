#pragma once

#include <memory>

#include "ode/integrator.hpp"

namespace fw::integrators {

/// Symplectic (semi-implicit) Euler, the loop that the lecture prints: v' = v + h M⁻¹ f(t, x, v), then
/// x' = x + h v' with the *new* velocity [Zachmann 2011, S9; erratum E3; Hairer, Lubich, Wanner 2006, I.1].
std::unique_ptr<Integrator> make_symplectic_euler();

}  // namespace fw::integrators
