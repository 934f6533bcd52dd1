#pragma once

#include <memory>

#include "ode/integrator.hpp"

namespace fw::integrators {

/// Implicit Euler, y' = y + h f(t + h, y'), by Newton's iteration to convergence with the exact Jacobian and
/// KLU [Zachmann 2011, S22; Hairer, Wanner 1996, IV.3].
///
/// A second-order system is reduced to its velocities: M (v' − v) = h f(t + h, x + h v', v') with the matrix
/// M − h D − h² K of half the size. A correction that would increase the residual is halved.
std::unique_ptr<Integrator> make_implicit_euler();

}  // namespace fw::integrators
