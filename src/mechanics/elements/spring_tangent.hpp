#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "mechanics/elements/central_force_tangent.hpp"
#include "mechanics/elements/spring_force.hpp"
#include "ode/second_order_system.hpp"

namespace fw::mechanics {

/// ∂f_i/∂x_j and ∂f_i/∂v_j of a spring (i, j); since f depends on d and w only and f_j = −f_i,
/// K_ij = K_ji = k and K_ii, K_jj −= k, and likewise D (the lecture's slides S28-S30 print two of the signs
/// and a factor 2 wrongly).
///
///   k = σ' r rᵀ + (σ/L)(I − r rᵀ) + (k_d/L) [ (w·r)(I − r rᵀ) + r wᵀ(I − r rᵀ) ],   ∂f_i/∂v_j = k_d r rᵀ.
///
/// `model` changes k only:
///  - `exact`: as above;
///  - `tensile_geometric_term`: σ/L is replaced by max(σ/L, 0);
///  - `psd_projection`: the nearest positive semi-definite elastic block, and without the damper's part,
///  which
///    is not symmetric and has no definite sign. The elastic eigenvalues are σ' ≥ 0 and twice σ/L, so that
///    the projection is again max(σ/L, 0). The damper stays in ∂f/∂v, where it is definite.
///
/// At L = 0 everything is zero, as the force is, and `degenerate` goes up by one; if l₀ = 0 the elastic block
/// is k_s I there.
template <SpringLaw Law>
CentralForceTangent spring_tangent(const SpringParameters& spring, const Vec3<double>& d,
                                   const Vec3<double>& w, TangentModel model, std::uint64_t& degenerate) {
  const double length_squared = dot(d, d);
  if (length_squared == 0.0) {
    ++degenerate;
    CentralForceTangent tangent;
    if (spring.rest_length == 0.0) tangent.axial = tangent.transverse = spring.stiffness;
    return tangent;
  }
  const double length = std::sqrt(length_squared);
  CentralForceTangent tangent;
  tangent.direction = (1.0 / length) * d;
  tangent.axial = spring_acts<Law>(spring, length) ? spring_rate<Law>(spring) : 0.0;
  tangent.transverse = spring_tension<Law>(spring, length) / length;
  tangent.damping = spring.damping;
  if (model != TangentModel::exact) tangent.transverse = std::max(tangent.transverse, 0.0);
  if (model != TangentModel::psd_projection) {
    const double lengthening = dot(w, tangent.direction);
    const double rate = spring.damping / length;
    tangent.transverse += rate * lengthening;
    tangent.turning = rate * (w - lengthening * tangent.direction);
  }
  return tangent;
}

}  // namespace fw::mechanics
