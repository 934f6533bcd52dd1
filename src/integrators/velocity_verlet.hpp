#pragma once

#include <memory>

#include "ode/integrator.hpp"

namespace fw::integrators {

/// Velocity Verlet [Swope, Andersen, Berens, Wilson 1982], one force per step:
///   v½ = v + ½h M⁻¹f(t, x, v),  x' = x + h v½,  v' = v½ + ½h M⁻¹f(t + h, x', v').
/// Where f depends on v the last half-kick is implicit and solved (see `ImplicitKick`), which keeps order 2.
std::unique_ptr<Integrator> make_velocity_verlet();

}  // namespace fw::integrators
