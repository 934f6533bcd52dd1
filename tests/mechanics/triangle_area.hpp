#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/extended_precision.hpp"
#include "mechanics/elements/element_validation.hpp"
#include "mechanics/elements/tangent_blocks.hpp"
#include "ode/second_order_system.hpp"

namespace fw::mechanics {

/// A triangle that resists a change of its area A: energy ½ k (A − A₀)²/A₀, power lost c Ȧ²/A₀.
struct Triangle {
  std::array<int, 3> particles{};
  double rest_area = 1.0;  ///< A₀ [m²]
  double stiffness = 0.0;  ///< k [N/m]
  double damping = 0.0;    ///< c [N·s/m]
};

/// Triangles with f_a = −s g_a, g_a = ∂A/∂x_a = ½ n̂ × e_a (e_a the edge opposite to corner a), s = (k (A −
/// A₀) + c Ȧ)/A₀ [N/m]. A force element of the tests: what it takes to add one is this file and a line in a
/// list.
struct TriangleAreaBatch {
  static constexpr int arity = 3;
  static constexpr ElementLabels labels{.kind = "triangles", .role = ElementRole::elastic, .energy = "area"};
  using Tangent = CliqueTangent<3>;

  std::vector<Triangle> triangles;

  std::size_t size() const { return triangles.size(); }
  std::array<int, 3> nodes(std::size_t e) const { return triangles[e].particles; }

  template <class Scalar>
  NodeVectors<Scalar, 3> force(std::size_t e, const NodeVectors<Scalar, 3>& x,
                               const NodeVectors<Scalar, 3>& v, std::uint64_t& degenerate) const {
    const Triangle& triangle = triangles[e];
    const Vec3<Scalar> normal = cross(x[1] - x[0], x[2] - x[0]);
    if (real_part(dot(normal, normal)) == 0) {
      ++degenerate;
      return {};
    }
    const Scalar twice_area = norm(normal);
    const Vec3<Scalar> n = (Scalar(1) / twice_area) * normal;
    const NodeVectors<Scalar, 3> g = {Scalar(0.5) * cross(n, x[2] - x[1]),
                                      Scalar(0.5) * cross(n, x[0] - x[2]),
                                      Scalar(0.5) * cross(n, x[1] - x[0])};
    const Scalar rate = dot(g[0], v[0]) + dot(g[1], v[1]) + dot(g[2], v[2]);
    const Scalar tension =
        (triangle.stiffness * (0.5 * twice_area - triangle.rest_area) + triangle.damping * rate) /
        triangle.rest_area;
    return {-tension * g[0], -tension * g[1], -tension * g[2]};
  }

  bool tangent(std::size_t e, const NodeVectors<double, 3>& x, const NodeVectors<double, 3>& v,
               TangentModel model, Tangent& out, std::uint64_t& degenerate) const {
    using Vector3 = Eigen::Vector3d;
    const Triangle& triangle = triangles[e];
    const auto at = [](const Vec3<double>& a) { return Vector3(a.x, a.y, a.z); };
    const std::array<Vector3, 3> edge = {at(x[2] - x[1]), at(x[0] - x[2]), at(x[1] - x[0])};
    const Vector3 normal = -edge[2].cross(edge[1]);
    const double twice_area = normal.norm();
    if (twice_area == 0.0) {
      ++degenerate;
      return false;
    }
    const Vector3 n = normal / twice_area;
    const Matrix3 across = Matrix3::Identity() - n * n.transpose();
    std::array<Vector3, 3> g;
    std::array<Matrix3, 9> hessian;  // ∂g_a/∂x_b
    for (std::size_t a = 0; a < 3; ++a) {
      g[a] = 0.5 * n.cross(edge[a]);
      for (std::size_t b = 0; b < 3; ++b) {
        const double sign = a == b ? 0.0 : (b == (a + 1) % 3 ? -1.0 : 1.0);
        hessian[3 * a + b] =
            0.5 * (sign * turning(n) - turning(edge[a]) * across * turning(edge[b]) / twice_area);
      }
    }
    double rate = 0.0;
    std::array<Vector3, 3> rate_gradient = {Vector3::Zero(), Vector3::Zero(), Vector3::Zero()};
    for (std::size_t b = 0; b < 3; ++b) {
      rate += g[b].dot(at(v[b]));
      for (std::size_t c = 0; c < 3; ++c) rate_gradient[b] += hessian[3 * b + c] * at(v[c]);
    }
    const double k = triangle.stiffness / triangle.rest_area, c = triangle.damping / triangle.rest_area;
    const double tension = k * (0.5 * twice_area - triangle.rest_area) + c * rate;
    const bool projected = model == TangentModel::psd_projection;
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < 3; ++b) {
        const int row = static_cast<int>(a), column = static_cast<int>(b);
        out.position(row, column) = -k * g[a] * g[b].transpose();
        if (!projected) {
          out.position(row, column) -= c * g[a] * rate_gradient[b].transpose() + tension * hessian[3 * a + b];
        }
        out.velocity(row, column) = -c * g[a] * g[b].transpose();
      }
    }
    return true;
  }

  template <class Scalar>
  Scalar energy(std::size_t e, const NodeVectors<Scalar, 3>& x) const {
    const Triangle& triangle = triangles[e];
    const Scalar excess = 0.5 * norm(cross(x[1] - x[0], x[2] - x[0])) - triangle.rest_area;
    return 0.5 * triangle.stiffness / triangle.rest_area * excess * excess;
  }
  double dissipated_power(std::size_t e, const NodeVectors<double, 3>& x, const NodeVectors<double, 3>& v,
                          std::uint64_t& degenerate) const {
    const NodeVectors<double, 3> with = force(e, x, v, degenerate), without = force(e, x, {}, degenerate);
    double power = 0.0;
    for (std::size_t a = 0; a < 3; ++a) power -= dot(with[a] - without[a], v[a]);
    return power;
  }

  ForceClass force_class() const {
    for (const Triangle& triangle : triangles) {
      if (triangle.damping > 0.0) return ForceClass::velocity;
    }
    return ForceClass::position;
  }
  bool has_kinks() const { return false; }
  bool is_internal() const { return true; }
  void validate(std::size_t particles) const {
    for (std::size_t e = 0; e < triangles.size(); ++e) {
      for (const int particle : triangles[e].particles) {
        require_particle("triangles", e, ".particles", particle, particles);
      }
      require_not_negative("triangles", e, ".stiffness", triangles[e].stiffness);
    }
  }

 private:
  /// The matrix of a × ….
  static Matrix3 turning(const Eigen::Vector3d& a) {
    Matrix3 matrix;
    matrix << 0.0, -a[2], a[1], a[2], 0.0, -a[0], -a[1], a[0], 0.0;
    return matrix;
  }
};

}  // namespace fw::mechanics
