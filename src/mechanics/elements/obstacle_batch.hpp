#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "mechanics/elements/obstacle_force.hpp"
#include "mechanics/elements/obstacle_switching.hpp"
#include "mechanics/elements/obstacle_tangent.hpp"
#include "mechanics/elements/tangent_blocks.hpp"

namespace fw::mechanics {

/// One obstacle against all particles [Zachmann 2011, S9]; element e is particle e. `Shape` is the
/// alternative that `obstacle->shape` holds, so that the loop does not branch on it. A view: the obstacle has
/// to outlive it.
template <class Shape>
struct ObstacleBatch {
  static constexpr int arity = 1;
  static constexpr ElementLabels labels{
      .kind = "obstacles", .role = ElementRole::external, .energy = "obstacle"};
  using Tangent = PointTangent<CentralForceTangent>;

  const Obstacle* obstacle = nullptr;
  std::size_t number = 0;     ///< of the obstacle, for messages
  std::size_t particles = 0;  ///< how many there are

  const Shape& shape() const { return *std::get_if<Shape>(&obstacle->shape); }

  std::size_t size() const { return particles; }
  std::array<int, 1> nodes(std::size_t e) const { return {static_cast<int>(e)}; }

  /// See `obstacle_force`.
  template <class Scalar>
  NodeVectors<Scalar, 1> force(std::size_t, const NodeVectors<Scalar, 1>& x, const NodeVectors<Scalar, 1>& v,
                               std::uint64_t&) const {
    return {obstacle_force(*obstacle, shape(), x[0], v[0])};
  }
  /// See `obstacle_tangent`; nothing where the obstacle does not press.
  bool tangent(std::size_t, const NodeVectors<double, 1>& x, const NodeVectors<double, 1>& v,
               TangentModel model, Tangent& out, std::uint64_t&) const {
    out.local = obstacle_tangent(*obstacle, shape(), x[0], v[0], model);
    return out.local.axial != 0.0 || out.local.damping != 0.0;
  }
  /// See `obstacle_energy`.
  template <class Scalar>
  Scalar energy(std::size_t, const NodeVectors<Scalar, 1>& x) const {
    return obstacle_energy(*obstacle, shape(), x[0]);
  }
  /// See `obstacle_dissipated_power`.
  double dissipated_power(std::size_t, const NodeVectors<double, 1>& x, const NodeVectors<double, 1>& v,
                          std::uint64_t&) const {
    return obstacle_dissipated_power(*obstacle, shape(), x[0], v[0]);
  }

  /// See `obstacle_phase`.
  template <class Scalar>
  int phase(std::size_t, const NodeVectors<Scalar, 1>& x, const NodeVectors<Scalar, 1>& v) const {
    return obstacle_phase(*obstacle, shape(), x[0], v[0]);
  }
  /// See `obstacle_stays`.
  template <class Scalar>
  bool stays(std::size_t, int phase, const NodePaths<Scalar, 1>& path) const {
    return obstacle_stays(*obstacle, shape(), phase, path[0]);
  }
  /// See `obstacle_kink`.
  Kink kink(std::size_t, int from, int to, const NodeVectors<double, 1>& x, const NodeVectors<double, 1>& v,
            double speed, double acceleration) const {
    return obstacle_kink(*obstacle, shape(), from, to, x[0], v[0], speed, acceleration);
  }
  std::size_t switch_number(std::size_t) const { return number; }

  ForceClass force_class() const {
    return obstacle->damping > 0.0 ? ForceClass::velocity : ForceClass::position;
  }
  bool has_kinks() const { return true; }
  bool is_internal() const { return false; }
  void validate(std::size_t) const;
};

/// Throws InputError that names the first entry that is out of its range.
void validate_obstacle(const Obstacle& obstacle, std::size_t number);

template <class Shape>
void ObstacleBatch<Shape>::validate(std::size_t) const {
  validate_obstacle(*obstacle, number);
}

}  // namespace fw::mechanics
