#pragma once

#include <cstddef>
#include <cstdint>
#include <variant>

#include "core/vec3.hpp"
#include "mechanics/anchor_force.hpp"
#include "mechanics/mass_spring_model.hpp"
#include "mechanics/obstacle_force.hpp"
#include "mechanics/spring_force.hpp"

namespace fw::mechanics {

/// The numbers of spring `e`.
inline SpringParameters spring_parameters(const Springs& springs, std::size_t e) {
  return {springs.stiffness[e], springs.damping[e], springs.rest_length[e]};
}

/// Adds the forces of all springs to `f`; returns how many springs had no direction.
template <SpringLaw Law, class Scalar>
std::uint64_t add_spring_forces(const Springs& springs, const Scalar* q, const Scalar* v, Scalar* f) {
  std::uint64_t degenerate = 0;
  for (std::size_t e = 0; e < springs.size(); ++e) {
    const int i = springs.first[e];
    const int j = springs.second[e];
    const Vec3<Scalar> force = spring_force<Law>(spring_parameters(springs, e), load3(q, j) - load3(q, i),
                                                 load3(v, j) - load3(v, i), degenerate);
    add3(f, i, force);
    add3(f, j, -force);
  }
  return degenerate;
}

/// f(q, v) [N]: gravity, drag, springs, anchors and obstacles; zero on fixed particles. `q`, `v` and `f` hold
/// xyz after xyz; `f` may alias neither. Returns how many springs had no direction (see `spring_force`).
///
/// The plain loop in the order of the springs: the one force of the project in every arithmetic, and the
/// oracle of any faster kernel. It allocates nothing.
template <class Scalar>
std::uint64_t mass_spring_force(const MassSpringModel& model, const Scalar* q, const Scalar* v, Scalar* f) {
  const auto count = static_cast<std::ptrdiff_t>(model.mass.size());
  const Vec3<Scalar> gravity{Scalar(model.gravity.x), Scalar(model.gravity.y), Scalar(model.gravity.z)};
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const Scalar mass(model.mass[static_cast<std::size_t>(i)]);
    store3(f, i, mass * gravity - Scalar(model.drag) * load3(v, i));
  }
  const std::uint64_t degenerate = with_spring_law(
      model.springs.law, [&](auto law) { return add_spring_forces<law()>(model.springs, q, v, f); });
  for (const Anchor& anchor : model.anchors) {
    const int i = anchor.particle;
    add3(f, i, anchor_force(anchor, load3(q, i), load3(v, i)));
  }
  for (const Obstacle& obstacle : model.obstacles) {
    std::visit(
        [&](const auto& shape) {
          for (std::ptrdiff_t i = 0; i < count; ++i) {
            add3(f, i, obstacle_force(obstacle, shape, load3(q, i), load3(v, i)));
          }
        },
        obstacle.shape);
  }
  for (const int i : model.fixed) store3(f, i, Vec3<Scalar>{});
  return degenerate;
}

}  // namespace fw::mechanics
