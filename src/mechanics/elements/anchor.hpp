#pragma once

#include "core/vec3.hpp"

namespace fw::mechanics {

/// Ties a point to its rest position: force −k (x − x₀) − c v [Zachmann 2011, S37].
struct Anchor {
  int particle = 0;
  Vec3<double> rest_position;  ///< x₀ [m]
  double stiffness = 0.0;      ///< k [N/m]
  double damping = 0.0;        ///< c [N·s/m]
};

/// x − x₀ [m], from where the anchor holds its particle to where the particle is.
template <class Scalar>
Vec3<Scalar> anchor_offset(const Anchor& anchor, const Vec3<Scalar>& x) {
  return x - Vec3<Scalar>{Scalar(anchor.rest_position.x), Scalar(anchor.rest_position.y),
                          Scalar(anchor.rest_position.z)};
}

/// −k (x − x₀) − c v [N] [Zachmann 2011, S37].
template <class Scalar>
Vec3<Scalar> anchor_force(const Anchor& anchor, const Vec3<Scalar>& x, const Vec3<Scalar>& v) {
  return Scalar(-anchor.stiffness) * anchor_offset(anchor, x) - Scalar(anchor.damping) * v;
}

/// ½ k ‖x − x₀‖² [J].
template <class Scalar>
Scalar anchor_energy(const Anchor& anchor, const Vec3<Scalar>& x) {
  const Vec3<Scalar> offset = anchor_offset(anchor, x);
  return 0.5 * anchor.stiffness * dot(offset, offset);
}

}  // namespace fw::mechanics
