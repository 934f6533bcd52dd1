#pragma once

#include <memory>

#include "ode/integrator.hpp"

namespace fw::integrators {

struct ProjectiveDynamicsOptions {
  int iterations = 10;  ///< local–global iterations per step, a fixed count as in graphics
};

/// Fast mass-spring simulation [Liu, Bargteil, O'Brien, Kavan 2013], also known as projective dynamics:
/// implicit Euler for springs and anchors by block coordinate descent on
///   ½ ‖q' − s‖²_M / h² + Σ_springs ½ k ‖d' − p‖²,   s = q + h v + h² M⁻¹ f_ext(t + h, q, v),   ‖p‖ = l₀.
/// Local step: p = l₀ d'/‖d'‖ for each spring (p = d' where a rope is slack). Global step: (M + h²L) q' = M s
/// + h² J p with the constant matrix M + h²L, factorised by Cholesky once per step length. v' = (q' − q)/h.
///
/// Gravity, drag, obstacles and all dampers are explicit, in f_ext at the start of the step, so that they
/// restrict the step. With many iterations the scheme is implicit Euler with that force. With few it is still
/// of order 1, since one iteration from s gives the spring forces at s; but where h²k/m ≫ 1 it is not
/// converged, and the error is that of the iteration: springs look softer and the motion more damped than
/// implicit Euler's.
std::unique_ptr<Integrator> make_projective_dynamics(const ProjectiveDynamicsOptions& options = {});

}  // namespace fw::integrators
