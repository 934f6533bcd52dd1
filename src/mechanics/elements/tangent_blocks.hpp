#pragma once

#include <array>
#include <cstddef>

#include "mechanics/elements/central_force_tangent.hpp"
#include "mechanics/elements/element_labels.hpp"

namespace fw::mechanics {

/// The derivative of the forces of one element with N nodes by their places or velocities, as N×N blocks:
/// block (a, b), `sign(a, b)` times `stored(a, b)`, is ∂f_a/∂x_b [N/m] or ∂f_a/∂v_b [N·s/m].
template <int N>
struct CliqueBlocks {
  std::array<Matrix3, static_cast<std::size_t>(N* N)> block;

  Matrix3& operator()(int a, int b) { return block[static_cast<std::size_t>(N * a + b)]; }
  const Matrix3& stored(int a, int b) const { return block[static_cast<std::size_t>(N * a + b)]; }
  static double sign(int, int) { return 1.0; }
};

/// The blocks of an element with one node.
struct PointBlocks {
  Matrix3 block;
  const Matrix3& stored(int, int) const { return block; }
  static double sign(int, int) { return 1.0; }
};

/// The blocks of two nodes whose forces are f and −f and depend on x_1 − x_0 and v_1 − v_0 alone: `coupling`
/// off the diagonal and its negative on it.
struct PairBlocks {
  Matrix3 coupling;
  const Matrix3& stored(int, int) const { return coupling; }
  static double sign(int a, int b) { return a == b ? -1.0 : 1.0; }
};

/// α·a + β·b.
template <int N>
CliqueBlocks<N> combine(double alpha, const CliqueBlocks<N>& a, double beta, const CliqueBlocks<N>& b) {
  CliqueBlocks<N> sum;
  for (std::size_t k = 0; k < sum.block.size(); ++k) sum.block[k] = alpha * a.block[k] + beta * b.block[k];
  return sum;
}
inline PointBlocks combine(double alpha, const PointBlocks& a, double beta, const PointBlocks& b) {
  return {alpha * a.block + beta * b.block};
}
inline PairBlocks combine(double alpha, const PairBlocks& a, double beta, const PairBlocks& b) {
  return {alpha * a.coupling + beta * b.coupling};
}

/// The tangent of an element with one node: `Local` is a `CentralForceTangent` or an `IsotropicTangent`.
template <class Local>
struct PointTangent {
  Local local;

  PointBlocks position_blocks() const { return {local.position_block()}; }
  PointBlocks velocity_blocks() const { return {local.velocity_block()}; }
  /// K·dx + D·dv.
  NodeVectors<double, 1> product(const NodeVectors<double, 1>& dx, const NodeVectors<double, 1>& dv) const {
    return {local.product(dx[0], dv[0])};
  }
};

/// The tangent of an element with two nodes and the forces f and −f along the line between them; `coupling`
/// has ∂f_0/∂(x_1 − x_0) and ∂f_0/∂(v_1 − v_0).
struct PairTangent {
  CentralForceTangent coupling;

  PairBlocks position_blocks() const { return {coupling.position_block()}; }
  PairBlocks velocity_blocks() const { return {coupling.velocity_block()}; }
  /// K·dx + D·dv.
  NodeVectors<double, 2> product(const NodeVectors<double, 2>& dx, const NodeVectors<double, 2>& dv) const {
    const Vec3<double> df = coupling.product(dx[1] - dx[0], dv[1] - dv[0]);
    return {df, -df};
  }
};

/// The tangent of an element with N nodes, block by block.
template <int N>
struct CliqueTangent {
  CliqueBlocks<N> position;  ///< ∂f_a/∂x_b [N/m]
  CliqueBlocks<N> velocity;  ///< ∂f_a/∂v_b [N·s/m]

  const CliqueBlocks<N>& position_blocks() const { return position; }
  const CliqueBlocks<N>& velocity_blocks() const { return velocity; }
  /// K·dx + D·dv.
  NodeVectors<double, N> product(const NodeVectors<double, N>& dx, const NodeVectors<double, N>& dv) const {
    NodeVectors<double, N> df{};
    for (int a = 0; a < N; ++a) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (int b = 0; b < N; ++b) {
        const Vec3<double>& x = dx[static_cast<std::size_t>(b)];
        const Vec3<double>& v = dv[static_cast<std::size_t>(b)];
        sum += position.stored(a, b) * Eigen::Vector3d(x.x, x.y, x.z) +
               velocity.stored(a, b) * Eigen::Vector3d(v.x, v.y, v.z);
      }
      df[static_cast<std::size_t>(a)] = {sum[0], sum[1], sum[2]};
    }
    return df;
  }
};

/// The forces of an element over a step of an energy-momentum scheme and their derivatives.
template <int N, class Blocks>
struct DiscreteForce {
  NodeVectors<double, N> force;  ///< [N]
  Blocks position;               ///< by the places at the end of the step [N/m]
  Blocks velocity;               ///< by the mean velocities [N·s/m]
};

}  // namespace fw::mechanics
