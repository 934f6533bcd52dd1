#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mechanics/elements/element_validation.hpp"
#include "mechanics/elements/tangent_blocks.hpp"
#include "ode/second_order_system.hpp"

namespace fw::mechanics {

/// A tetrahedron that resists a change of its volume V: energy ½ k (V − V₀)²/V₀ with k in pascals.
struct Tetrahedron {
  std::array<int, 4> particles{};
  double rest_volume = 1.0;  ///< V₀ [m³]
  double stiffness = 0.0;    ///< k [Pa]
};

/// Tetrahedra with f_a = −k (V − V₀)/V₀ ∂V/∂x_a: an element with four nodes, for the tests.
struct TetrahedronVolumeBatch {
  static constexpr int arity = 4;
  static constexpr ElementLabels labels{
      .kind = "tetrahedra", .role = ElementRole::elastic, .energy = "volume"};
  using Tangent = CliqueTangent<4>;

  std::vector<Tetrahedron> tetrahedra;

  std::size_t size() const { return tetrahedra.size(); }
  std::array<int, 4> nodes(std::size_t e) const { return tetrahedra[e].particles; }

  template <class Scalar>
  static NodeVectors<Scalar, 4> gradient(const NodeVectors<Scalar, 4>& x) {
    const Vec3<Scalar> a = x[1] - x[0], b = x[2] - x[0], c = x[3] - x[0];
    const Scalar sixth = Scalar(1) / Scalar(6);
    const Vec3<Scalar> ga = sixth * cross(b, c), gb = sixth * cross(c, a), gc = sixth * cross(a, b);
    return {-(ga + gb + gc), ga, gb, gc};
  }
  template <class Scalar>
  static Scalar volume(const NodeVectors<Scalar, 4>& x) {
    return dot(x[1] - x[0], cross(x[2] - x[0], x[3] - x[0])) / Scalar(6);
  }

  template <class Scalar>
  NodeVectors<Scalar, 4> force(std::size_t e, const NodeVectors<Scalar, 4>& x, const NodeVectors<Scalar, 4>&,
                               std::uint64_t&) const {
    const Tetrahedron& own = tetrahedra[e];
    const Scalar pressure = own.stiffness * (volume(x) - own.rest_volume) / own.rest_volume;
    NodeVectors<Scalar, 4> f = gradient(x);
    for (Vec3<Scalar>& component : f) component = -pressure * component;
    return f;
  }
  bool tangent(std::size_t e, const NodeVectors<double, 4>& x, const NodeVectors<double, 4>&,
               TangentModel model, Tangent& out, std::uint64_t&) const {
    const Tetrahedron& own = tetrahedra[e];
    const auto at = [](const Vec3<double>& a) { return Eigen::Vector3d(a.x, a.y, a.z); };
    const NodeVectors<double, 4> g = gradient(x);
    const double k = own.stiffness / own.rest_volume;
    const double pressure = model == TangentModel::psd_projection ? 0.0 : k * (volume(x) - own.rest_volume);
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        // ∂²V/∂x_a∂x_b is the cross product with the edge between the two others, over 6.
        Matrix3 hessian = Matrix3::Zero();
        for (int c = 0; c < 4; ++c) {
          for (int d = 0; d < 4; ++d) {
            const int parity = (b - a) * (c - a) * (d - a) * (c - b) * (d - b) * (d - c);
            if (parity == 0 || c > d) continue;
            const Eigen::Vector3d w = (parity > 0 ? -1.0 : 1.0) / 6.0 *
                                      at(x[static_cast<std::size_t>(d)] - x[static_cast<std::size_t>(c)]);
            hessian << 0.0, -w[2], w[1], w[2], 0.0, -w[0], -w[1], w[0], 0.0;
          }
        }
        out.position(a, b) =
            -k * at(g[static_cast<std::size_t>(a)]) * at(g[static_cast<std::size_t>(b)]).transpose() -
            pressure * hessian;
        out.velocity(a, b).setZero();
      }
    }
    return true;
  }
  template <class Scalar>
  Scalar energy(std::size_t e, const NodeVectors<Scalar, 4>& x) const {
    const Tetrahedron& own = tetrahedra[e];
    const Scalar excess = volume(x) - own.rest_volume;
    return 0.5 * own.stiffness / own.rest_volume * excess * excess;
  }
  double dissipated_power(std::size_t, const NodeVectors<double, 4>&, const NodeVectors<double, 4>&,
                          std::uint64_t&) const {
    return 0.0;
  }
  ForceClass force_class() const { return ForceClass::position; }
  bool has_kinks() const { return false; }
  bool is_internal() const { return true; }
  void validate(std::size_t particles) const {
    for (std::size_t e = 0; e < tetrahedra.size(); ++e) {
      for (const int particle : tetrahedra[e].particles) {
        require_particle("tetrahedra", e, ".particles", particle, particles);
      }
    }
  }
};

}  // namespace fw::mechanics
