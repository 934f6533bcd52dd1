#pragma once

#include <Eigen/Core>

#include "core/vec3.hpp"

namespace fw::mechanics {

using Matrix3 = Eigen::Matrix3d;

/// The derivative of a force along a unit direction r that turns with the position x, that is, of a spring, a
/// damper or a penalty force. It is kept as its few coefficients, from which both the 3×3 blocks and the
/// products without assembly are made:
///   ∂f/∂x = a r rᵀ + b (I − r rᵀ) + r gᵀ,   ∂f/∂v = c r rᵀ,   with g ⊥ r.
struct CentralForceTangent {
  Vec3<double> direction{};  ///< r
  double axial = 0.0;        ///< a [N/m]
  double transverse = 0.0;   ///< b [N/m]: the force's magnitude over the radius at which r turns
  Vec3<double> turning{};    ///< g [N/m]: how the magnitude changes because r turns (dampers only)
  double damping = 0.0;      ///< c [N·s/m]

  /// ∂f/∂x.
  Matrix3 position_block() const {
    const Eigen::Vector3d r(direction.x, direction.y, direction.z);
    const Eigen::Vector3d g(turning.x, turning.y, turning.z);
    Matrix3 block = r * ((axial - transverse) * r + g).transpose();
    block.diagonal().array() += transverse;
    return block;
  }

  /// ∂f/∂v.
  Matrix3 velocity_block() const {
    const Eigen::Vector3d r(direction.x, direction.y, direction.z);
    return damping * r * r.transpose();
  }

  /// ∂f/∂x·dx + ∂f/∂v·dv.
  Vec3<double> product(const Vec3<double>& dx, const Vec3<double>& dv) const {
    const double along =
        (axial - transverse) * dot(direction, dx) + dot(turning, dx) + damping * dot(direction, dv);
    return along * direction + transverse * dx;
  }
};

/// The derivative of the force b x + c v + const of an anchor or of drag: b I and c I.
struct IsotropicTangent {
  double stiffness = 0.0;  ///< b [N/m], ≤ 0
  double damping = 0.0;    ///< c [N·s/m], ≤ 0

  Matrix3 position_block() const { return stiffness * Matrix3::Identity(); }
  Matrix3 velocity_block() const { return damping * Matrix3::Identity(); }
  Vec3<double> product(const Vec3<double>& dx, const Vec3<double>& dv) const {
    return stiffness * dx + damping * dv;
  }
};

}  // namespace fw::mechanics
