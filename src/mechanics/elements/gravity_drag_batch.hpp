#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/types.hpp"
#include "mechanics/elements/element_validation.hpp"
#include "mechanics/elements/tangent_blocks.hpp"
#include "ode/second_order_system.hpp"

namespace fw::mechanics {

/// Gravity and drag on all particles, m g − (c + α m) v; element e is particle e. A view: the masses have to
/// outlive it.
struct GravityDragBatch {
  static constexpr int arity = 1;
  static constexpr ElementLabels labels{
      .kind = "gravity and drag", .role = ElementRole::external, .energy = "gravitational"};
  using Tangent = PointTangent<IsotropicTangent>;

  std::span<const double> mass;  ///< [kg]
  Vec3<double> gravity{};        ///< g [m/s²]
  double drag = 0.0;             ///< c [kg/s]
  double mass_drag = 0.0;        ///< α, the part of Rayleigh damping in proportion to mass [1/s]

  std::size_t size() const { return mass.size(); }
  std::array<int, 1> nodes(std::size_t e) const { return {static_cast<int>(e)}; }

  /// m g − (c + α m) v [N].
  template <class Scalar>
  NodeVectors<Scalar, 1> force(std::size_t e, const NodeVectors<Scalar, 1>&, const NodeVectors<Scalar, 1>& v,
                               std::uint64_t&) const {
    return {Scalar(mass[e]) * gravity_as<Scalar>() - Scalar(drag_of(e)) * v[0]};
  }
  bool tangent(std::size_t e, const NodeVectors<double, 1>&, const NodeVectors<double, 1>&, TangentModel,
               Tangent& out, std::uint64_t&) const {
    out.local = {0.0, -drag_of(e)};
    return drag_of(e) != 0.0;
  }
  /// −m g·x [J].
  template <class Scalar>
  Scalar energy(std::size_t e, const NodeVectors<Scalar, 1>& x) const {
    return -(mass[e] * dot(gravity_as<Scalar>(), x[0]));
  }
  /// Σ (c + α m) v² over all particles [W]; v has 3 entries per particle. One sum over the array in place of
  /// one per particle where there is no α.
  double total_dissipated_power(const double* v) const {
    if (mass_drag == 0.0) return drag * ConstVectorMap(v, static_cast<Index>(3 * mass.size())).squaredNorm();
    double power = 0.0;
    for (std::size_t e = 0; e < mass.size(); ++e) {
      const Vec3<double> velocity = load3(v, static_cast<std::ptrdiff_t>(e));
      power += drag_of(e) * dot(velocity, velocity);
    }
    return power;
  }

  ForceClass force_class() const {
    return drag > 0.0 || mass_drag > 0.0 ? ForceClass::velocity : ForceClass::position;
  }
  bool has_kinks() const { return false; }
  bool is_internal() const { return norm(gravity) == 0.0 && drag == 0.0 && mass_drag == 0.0; }
  void validate(std::size_t) const {
    if (!is_finite(gravity)) {
      throw InputError(fmt::format("gravity: found {}, expected finite numbers", to_text(gravity)));
    }
    if (!(drag >= 0.0) || !std::isfinite(drag)) {
      throw InputError(fmt::format("drag: found {}, expected a finite number >= 0", drag));
    }
    if (!(mass_drag >= 0.0) || !std::isfinite(mass_drag)) {
      throw InputError(fmt::format("mass_drag: found {}, expected a finite number >= 0", mass_drag));
    }
  }

 private:
  /// c + α m [kg/s].
  double drag_of(std::size_t e) const { return drag + mass_drag * mass[e]; }
  template <class Scalar>
  Vec3<Scalar> gravity_as() const {
    return {Scalar(gravity.x), Scalar(gravity.y), Scalar(gravity.z)};
  }
};

}  // namespace fw::mechanics
