#pragma once

#include <cmath>

#include "mechanics/elements/central_force_tangent.hpp"
#include "mechanics/elements/spring_force.hpp"

namespace fw::mechanics {

/// (V(L') − V(L))/(L' − L) of a spring's energy V [N], and σ(L) where L' = L. Evaluated without cancellation:
/// with the elongations e = L − l₀, cut off at 0 where the law has no compression, it is ½ σ' (e + e') (e' −
/// e)/(L' − L).
template <SpringLaw Law>
double mean_tension(const SpringParameters& spring, double length, double new_length) {
  const double before = length - spring.rest_length;
  const double after = new_length - spring.rest_length;
  const double rate = spring_rate<Law>(spring);
  if constexpr (Law == SpringLaw::tension_only) {
    if (before <= 0.0 && after <= 0.0) return 0.0;
    if (before > 0.0 && after > 0.0) return 0.5 * rate * (before + after);
    const double stretched = before > 0.0 ? before : after;  // the rope tightens or slackens within the step
    return 0.5 * rate * stretched * stretched / std::abs(after - before);
  } else {
    return 0.5 * rate * (before + after);
  }
}

/// ∂(mean tension)/∂L'.
template <SpringLaw Law>
double mean_tension_slope(const SpringParameters& spring, double length, double new_length) {
  const double before = length - spring.rest_length;
  const double after = new_length - spring.rest_length;
  const double rate = spring_rate<Law>(spring);
  if constexpr (Law == SpringLaw::tension_only) {
    if (before <= 0.0 && after <= 0.0) return 0.0;
    if (before <= 0.0 || after <= 0.0) {
      const double mean = mean_tension<Law>(spring, length, new_length);
      return ((after > 0.0 ? rate * after : 0.0) - mean) / (after - before);
    }
  }
  return 0.5 * rate;
}

/// The force on point i of a spring (i, j) over a step from d to d', and its derivatives by the end of the
/// step.
struct DiscreteSpringForce {
  Vec3<double> force{};                ///< [N]
  Matrix3 position = Matrix3::Zero();  ///< ∂force/∂d' [N/m]
  Matrix3 velocity = Matrix3::Zero();  ///< ∂force/∂w̄ [N·s/m], w̄ the mean relative velocity
};

/// σ̂ (d + d')/(L + L') with the mean tension σ̂: its work over d' − d is exactly V(L) − V(L'), and it acts
/// along the mean position, hence energy, linear and angular momentum are conserved [LaBudde, Greenspan 1976;
/// Gonzalez 1996; Simo, Tarnow, Wong 1992]. The damper acts along the same line, k_d (w̄·r̄) r̄. Zero where d +
/// d' or L + L' is zero.
template <SpringLaw Law>
DiscreteSpringForce discrete_spring_force(const SpringParameters& spring, const Vec3<double>& d,
                                          const Vec3<double>& new_d, const Vec3<double>& mean_w) {
  using Vector3 = Eigen::Vector3d;
  DiscreteSpringForce result;
  const double length = norm(d);
  const double new_length = norm(new_d);
  const double sum = length + new_length;
  if (sum == 0.0) {
    if (spring.rest_length == 0.0) result.position = 0.5 * spring.stiffness * Matrix3::Identity();
    return result;
  }
  const Vec3<double> e = d + new_d;
  const double tension = mean_tension<Law>(spring, length, new_length);
  result.force = (tension / sum) * e;
  result.position = (tension / sum) * Matrix3::Identity();
  const Vector3 direction(e.x, e.y, e.z);
  if (new_length > 0.0) {
    const double slope = mean_tension_slope<Law>(spring, length, new_length);
    const Vector3 r(new_d.x / new_length, new_d.y / new_length, new_d.z / new_length);
    result.position += ((slope - tension / sum) / sum) * direction * r.transpose();
  }
  const double width = direction.norm();
  if (spring.damping > 0.0 && width > 0.0) {
    const Vector3 r = direction / width;
    const Vector3 w(mean_w.x, mean_w.y, mean_w.z);
    const double closing = w.dot(r);
    result.force += Vec3<double>{spring.damping * closing * r[0], spring.damping * closing * r[1],
                                 spring.damping * closing * r[2]};
    const Matrix3 across = Matrix3::Identity() - r * r.transpose();
    result.position += (spring.damping / width) * (closing * across + r * (across * w).transpose());
    result.velocity = spring.damping * r * r.transpose();
  }
  return result;
}

}  // namespace fw::mechanics
