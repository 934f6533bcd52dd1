#include "scene/attachments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fw::scene {
namespace {

Vec3<double> read_unit_normal(const CheckedTable& table) {
  const Vec3<double> normal = table.vec3("normal");
  const double largest = std::max({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)});
  if (largest == 0.0) table.fail("normal", "found the zero vector, expected a direction");
  const Vec3<double> scaled{normal.x / largest, normal.y / largest, normal.z / largest};
  const double length = norm(scaled);
  return {scaled.x / length, scaled.y / length, scaled.z / length};
}

mechanics::Box read_box(const CheckedTable& table) {
  const mechanics::Box box{table.vec3("lower"), table.vec3("upper")};
  const std::array<double, 3> lower{box.lower.x, box.lower.y, box.lower.z};
  const std::array<double, 3> upper{box.upper.x, box.upper.y, box.upper.z};
  for (std::size_t a = 0; a < 3; ++a) {
    if (lower[a] < upper[a]) continue;
    table.fail("upper", {a},
               fmt::format("found {}, expected a number > lower[{}] = {}", upper[a], a, lower[a]));
  }
  return box;
}

}  // namespace

void read_anchors(const CheckedTable& root, const std::vector<PointGroup>& groups, Scene& scene) {
  const std::size_t count = scene.model.mass.size();
  std::vector<char> fixed(count, 0);
  for (const int i : scene.model.fixed) fixed[static_cast<std::size_t>(i)] = 1;

  for (const CheckedTable& table : root.tables("anchor")) {
    const auto particles = read_points(table, "particle", count, groups);
    if (particles.empty()) table.fail("particle", "found no particle, expected at least one");
    const double stiffness = table.number("stiffness", NumberRule::nonnegative);
    const double damping = table.number_or("damping", 0.0, NumberRule::nonnegative);
    const bool has_position = table.has("position");
    if (has_position && particles.size() > 1) {
      table.fail("position",
                 fmt::format("found a position for {} particles, expected one only for a single particle",
                             particles.size()));
    }
    if (particles.size() == 1) table.vec3_or("position", load3(scene.position.data(), particles[0]));
    std::size_t without_effect = 0;
    for (const int i : particles) {
      const Vec3<double> rest = has_position ? table.vec3("position") : load3(scene.position.data(), i);
      scene.model.anchors.push_back({i, rest, stiffness, damping});
      if (fixed[static_cast<std::size_t>(i)]) ++without_effect;
    }
    if (without_effect > 0) {
      scene.warnings.push_back(
          fmt::format("{}: {} of the {} anchored particles {} fixed: there the anchor has no effect",
                      table.where(), without_effect, particles.size(), without_effect == 1 ? "is" : "are"));
    }
  }
}

void read_obstacles(const CheckedTable& root, Scene& scene) {
  for (const CheckedTable& table : root.tables("obstacle")) {
    mechanics::Obstacle obstacle;
    const std::string shape = table.choice("shape", {"plane", "sphere", "box"});
    if (shape == "plane") {
      obstacle.shape = mechanics::Plane{table.vec3("point"), read_unit_normal(table)};
    } else if (shape == "sphere") {
      obstacle.shape = mechanics::Sphere{table.vec3("centre"), table.positive_number("radius")};
    } else {
      obstacle.shape = read_box(table);
    }
    obstacle.stiffness = table.number("stiffness", NumberRule::nonnegative);
    obstacle.damping = table.number_or("damping", 0.0, NumberRule::nonnegative);
    scene.model.obstacles.push_back(std::move(obstacle));
  }
}

}  // namespace fw::scene
