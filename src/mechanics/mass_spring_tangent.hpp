#pragma once

#include <cstddef>
#include <cstdint>
#include <variant>

#include "mechanics/mass_spring_force.hpp"
#include "mechanics/obstacle_tangent.hpp"
#include "mechanics/spring_tangent.hpp"

namespace fw::mechanics {

/// Walks over the derivatives of all force elements in the order of `mass_spring_force`, and hands each to
///  - `visitor.point(i, tangent)`: ∂f_i/∂x_i and ∂f_i/∂v_i of drag, an anchor or an obstacle,
///  - `visitor.pair(e, i, j, tangent)`: ∂f_i/∂x_j and ∂f_i/∂v_j of spring e (see `spring_tangent`).
/// Fixed particles are visited too: whether a row is kept is the visitor's business. Returns how many springs
/// had no direction. Nothing is allocated.
template <class Visitor>
std::uint64_t visit_tangents(const MassSpringModel& model, const double* q, const double* v,
                             TangentModel tangent_model, Visitor&& visitor) {
  const auto count = static_cast<int>(model.mass.size());
  if (model.drag != 0.0) {
    for (int i = 0; i < count; ++i) visitor.point(i, IsotropicTangent{0.0, -model.drag});
  }
  const Springs& springs = model.springs;
  const std::uint64_t degenerate = with_spring_law(springs.law, [&](auto law) {
    std::uint64_t without_direction = 0;
    for (std::size_t e = 0; e < springs.size(); ++e) {
      const int i = springs.first[e];
      const int j = springs.second[e];
      visitor.pair(e, i, j,
                   spring_tangent<law()>(spring_parameters(springs, e), load3(q, j) - load3(q, i),
                                         load3(v, j) - load3(v, i), tangent_model, without_direction));
    }
    return without_direction;
  });
  for (const Anchor& anchor : model.anchors) {
    visitor.point(anchor.particle, IsotropicTangent{-anchor.stiffness, -anchor.damping});
  }
  for (const Obstacle& obstacle : model.obstacles) {
    std::visit(
        [&](const auto& shape) {
          for (int i = 0; i < count; ++i) {
            const CentralForceTangent tangent =
                obstacle_tangent(obstacle, shape, load3(q, i), load3(v, i), tangent_model);
            if (tangent.axial != 0.0 || tangent.damping != 0.0) visitor.point(i, tangent);
          }
        },
        obstacle.shape);
  }
  return degenerate;
}

}  // namespace fw::mechanics
