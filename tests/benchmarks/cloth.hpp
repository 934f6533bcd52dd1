#pragma once

#include <fmt/format.h>

#include <memory>

#include "mechanics/mass_spring_system.hpp"
#include "scene/scene.hpp"

namespace fw::benchmarks {

/// The N×N cloth of all timings: structural, shear and bend springs, two pinned corners, dampers on every
/// spring.
struct Cloth {
  std::shared_ptr<const mechanics::MassSpringSystem> system;
  Vector state;
  std::int64_t springs() const { return static_cast<std::int64_t>(system->model().springs.size()); }
};

/// k_s = `stiffness` [N/m] and k_d = `damping` [N·s/m] on every spring, masses of 1 g.
inline Cloth make_cloth(int n, double stiffness = 1e4, double damping = 1.0) {
  scene::Scene scene = scene::parse_scene(
      fmt::format("title = \"cloth\"\n[world]\ngravity = [0, 0, -9.81]\n[generate]\nkind = \"cloth\"\ncounts "
                  "= [{0}, {0}]\n"
                  "size = [1, 1]\nmass = 1e-3\nstiffness = {1}\ndamping = {2}\npinned = \"top_corners\"\n",
                  n, stiffness, damping),
      "cloth.toml");
  Cloth cloth;
  cloth.state = initial_state(scene);
  // A smooth deformation, so that no spring is at rest.
  const Index particles = cloth.state.size() / 6;
  for (Index i = 0; i < particles; ++i) cloth.state[3 * i + 2] = 0.05 * std::sin(7.0 * cloth.state[3 * i]);
  cloth.system = std::make_shared<const mechanics::MassSpringSystem>(std::move(scene.model));
  return cloth;
}

}  // namespace fw::benchmarks
