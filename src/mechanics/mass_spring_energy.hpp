#pragma once

#include <cmath>
#include <cstddef>
#include <variant>

#include "core/vec3.hpp"
#include "mechanics/mass_spring_force.hpp"

namespace fw::mechanics {

/// ½ Σ m v² [J].
template <class Scalar>
Scalar kinetic_energy(const MassSpringModel& model, const Scalar* v) {
  Scalar energy(0);
  for (std::size_t i = 0; i < model.mass.size(); ++i) {
    const Vec3<Scalar> velocity = load3(v, static_cast<std::ptrdiff_t>(i));
    energy += 0.5 * model.mass[i] * dot(velocity, velocity);
  }
  return energy;
}

/// The energy stored in springs and anchors [J]. A spring of length zero stores what its law says, ½ k_s l₀².
template <class Scalar>
Scalar elastic_energy(const MassSpringModel& model, const Scalar* q) {
  const Springs& springs = model.springs;
  Scalar energy = with_spring_law(springs.law, [&](auto law) {
    Scalar sum(0);
    for (std::size_t e = 0; e < springs.size(); ++e) {
      const Scalar length = norm(load3(q, springs.second[e]) - load3(q, springs.first[e]));
      sum += spring_energy<law()>(spring_parameters(springs, e), length);
    }
    return sum;
  });
  for (const Anchor& anchor : model.anchors) energy += anchor_energy(anchor, load3(q, anchor.particle));
  return energy;
}

/// −Σ m g·x [J].
template <class Scalar>
Scalar gravitational_energy(const MassSpringModel& model, const Scalar* q) {
  const Vec3<Scalar> gravity{Scalar(model.gravity.x), Scalar(model.gravity.y), Scalar(model.gravity.z)};
  Scalar energy(0);
  for (std::size_t i = 0; i < model.mass.size(); ++i) {
    energy -= model.mass[i] * dot(gravity, load3(q, static_cast<std::ptrdiff_t>(i)));
  }
  return energy;
}

/// Σ ½ k δ² over all contacts [J].
template <class Scalar>
Scalar obstacle_energy(const MassSpringModel& model, const Scalar* q) {
  Scalar energy(0);
  for (const Obstacle& obstacle : model.obstacles) {
    std::visit(
        [&](const auto& shape) {
          for (std::size_t i = 0; i < model.mass.size(); ++i) {
            energy += obstacle_energy(obstacle, shape, load3(q, static_cast<std::ptrdiff_t>(i)));
          }
        },
        obstacle.shape);
  }
  return energy;
}

}  // namespace fw::mechanics
