#pragma once

#include "mechanics/elements/central_force_tangent.hpp"
#include "mechanics/elements/obstacle_force.hpp"
#include "ode/second_order_system.hpp"

namespace fw::mechanics {

/// ∂f/∂x and ∂f/∂v of the penalty force f = s n, s = max(k δ − c v·n, 0): zero where s is, otherwise
///
///   ∂f/∂x = −k n nᵀ + κ s (I − n nᵀ) − c κ n vᵀ(I − n nᵀ),   ∂f/∂v = −c n nᵀ,
///
/// κ the curvature of the solid's level set (1/‖x − centre‖ in a ball, zero under planes and faces). Pushing
/// outwards from a ball is unstable sideways: κ s > 0. `psd_projection` keeps −k n nᵀ only; the other two
/// models are exact (`tensile_geometric_term` speaks of springs).
template <class Shape>
CentralForceTangent obstacle_tangent(const Obstacle& obstacle, const Shape& shape, const Vec3<double>& x,
                                     const Vec3<double>& v, TangentModel model) {
  const Contact<double> at = contact(shape, x);
  if (!(at.depth > 0.0)) return {};
  const double magnitude = unclamped_penalty(obstacle, at, v);
  if (!(magnitude > 0.0)) return {};
  CentralForceTangent tangent;
  tangent.direction = at.normal;
  tangent.axial = -obstacle.stiffness;
  tangent.damping = -obstacle.damping;
  if (model != TangentModel::psd_projection) {
    tangent.transverse = at.curvature * magnitude;
    tangent.turning = (-obstacle.damping * at.curvature) * (v - dot(v, at.normal) * at.normal);
  }
  return tangent;
}

}  // namespace fw::mechanics
