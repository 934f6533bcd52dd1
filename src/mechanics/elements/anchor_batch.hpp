#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "mechanics/elements/anchor.hpp"
#include "mechanics/elements/element_validation.hpp"
#include "mechanics/elements/tangent_blocks.hpp"
#include "ode/second_order_system.hpp"

namespace fw::mechanics {

/// Anchors in the order in which they were given [Zachmann 2011, S37]. A view: the anchors have to outlive
/// it.
struct AnchorBatch {
  static constexpr int arity = 1;
  static constexpr ElementLabels labels{.kind = "anchors", .role = ElementRole::elastic, .energy = "elastic"};
  using Tangent = PointTangent<IsotropicTangent>;

  std::span<const Anchor> anchors;

  std::size_t size() const { return anchors.size(); }
  std::array<int, 1> nodes(std::size_t e) const { return {anchors[e].particle}; }

  /// See `anchor_force`.
  template <class Scalar>
  NodeVectors<Scalar, 1> force(std::size_t e, const NodeVectors<Scalar, 1>& x,
                               const NodeVectors<Scalar, 1>& v, std::uint64_t&) const {
    return {anchor_force(anchors[e], x[0], v[0])};
  }
  /// −c v [N].
  template <class Scalar>
  NodeVectors<Scalar, 1> damping_force(std::size_t e, const NodeVectors<Scalar, 1>&,
                                       const NodeVectors<Scalar, 1>& v) const {
    return {Scalar(-anchors[e].damping) * v[0]};
  }
  bool tangent(std::size_t e, const NodeVectors<double, 1>&, const NodeVectors<double, 1>&, TangentModel,
               Tangent& out, std::uint64_t&) const {
    out.local = {-anchors[e].stiffness, -anchors[e].damping};
    return true;
  }
  /// See `anchor_energy`.
  template <class Scalar>
  Scalar energy(std::size_t e, const NodeVectors<Scalar, 1>& x) const {
    return anchor_energy(anchors[e], x[0]);
  }
  /// c v² [W].
  double dissipated_power(std::size_t e, const NodeVectors<double, 1>&, const NodeVectors<double, 1>& v,
                          std::uint64_t&) const {
    return anchors[e].damping * dot(v[0], v[0]);
  }

  ForceClass force_class() const {
    return std::ranges::any_of(anchors, [](const Anchor& anchor) { return anchor.damping > 0.0; })
               ? ForceClass::velocity
               : ForceClass::position;
  }
  bool has_kinks() const { return false; }
  bool is_internal() const { return anchors.empty(); }
  void validate(std::size_t particles) const {
    for (std::size_t k = 0; k < anchors.size(); ++k) {
      require_particle("anchors", k, ".particle", anchors[k].particle, particles);
      require_finite("anchors", k, ".rest_position", anchors[k].rest_position);
      require_not_negative("anchors", k, ".stiffness", anchors[k].stiffness);
      require_not_negative("anchors", k, ".damping", anchors[k].damping);
    }
  }
};

}  // namespace fw::mechanics
