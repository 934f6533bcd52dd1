#pragma once

#include <memory>

#include "ode/integrator.hpp"

namespace fw::integrators {

/// Velocity Verlet whose dampers see a predicted velocity, so that nothing is solved and a step costs one
/// force [Groot, Warren 1997, with λ = 1]:
///   x_{n+1} = x_n + h v_n + ½h² a_n,
///   a_{n+1} = M⁻¹ f(t_{n+1}, x_{n+1}, v_n + h a_n),
///   v_{n+1} = v_n + ½h (a_n + a_{n+1}).
/// The prediction errs by O(h²) and the velocity in a step by O(h³): order 2 with dampers too. Without
/// velocity-dependent forces it is velocity Verlet. Strong dampers limit the step, as of an explicit scheme.
std::unique_ptr<Integrator> make_predicted_velocity_verlet();

}  // namespace fw::integrators
