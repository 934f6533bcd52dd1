#include "scene/attachments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fw::scene {
namespace {

Vec3<double> unit_normal(const Vec3<double>& normal, const CheckedTable& table) {
  const double largest = std::max({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)});
  if (largest == 0.0) table.fail("normal", "found the zero vector, expected a direction");
  const Vec3<double> scaled{normal.x / largest, normal.y / largest, normal.z / largest};
  const double length = norm(scaled);
  return {scaled.x / length, scaled.y / length, scaled.z / length};
}

mechanics::Box box_of(const ObstacleSpec& obstacle, const CheckedTable& table) {
  const mechanics::Box box{obstacle.lower, obstacle.upper};
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

void add_anchors(const std::vector<AnchorSpec>& anchors, const std::vector<PointGroup>& groups,
                 SceneFile& file, Scene& scene) {
  const std::size_t count = scene.model.mass.size();
  std::vector<char> fixed(count, 0);
  for (const int i : scene.model.fixed) fixed[static_cast<std::size_t>(i)] = 1;

  const std::vector<CheckedTable> tables = file.root.tables("anchor");
  for (std::size_t k = 0; k < anchors.size(); ++k) {
    const AnchorSpec& anchor = anchors[k];
    const CheckedTable& table = tables[k];
    const auto particles = select_points(anchor.particle, table, "particle", count, groups);
    if (particles.empty()) table.fail("particle", "found no particle, expected at least one");
    if (anchor.position && particles.size() > 1) {
      table.fail("position",
                 fmt::format("found a position for {} particles, expected one only for a single particle",
                             particles.size()));
    }
    if (!anchor.position && particles.size() == 1) {
      file.resolved.table("anchor", k).set("position", load3(scene.position.data(), particles[0]));
    }
    std::size_t without_effect = 0;
    for (const int i : particles) {
      const Vec3<double> rest = anchor.position.value_or(load3(scene.position.data(), i));
      scene.model.anchors.push_back({i, rest, anchor.stiffness, anchor.damping});
      if (fixed[static_cast<std::size_t>(i)]) ++without_effect;
    }
    if (without_effect > 0) {
      scene.warnings.push_back(
          fmt::format("{}: {} of the {} anchored particles {} fixed: there the anchor has no effect",
                      table.where(), without_effect, particles.size(), without_effect == 1 ? "is" : "are"));
    }
  }
}

void add_obstacles(const std::vector<ObstacleSpec>& obstacles, const SceneFile& file, Scene& scene) {
  const std::vector<CheckedTable> tables = file.root.tables("obstacle");
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    const ObstacleSpec& given = obstacles[k];
    mechanics::Obstacle obstacle;
    if (given.shape == "plane") {
      obstacle.shape = mechanics::Plane{given.point, unit_normal(given.normal, tables[k])};
    } else if (given.shape == "sphere") {
      obstacle.shape = mechanics::Sphere{given.centre, given.radius};
    } else {
      obstacle.shape = box_of(given, tables[k]);
    }
    obstacle.stiffness = given.stiffness;
    obstacle.damping = given.damping;
    scene.model.obstacles.push_back(std::move(obstacle));
  }
}

}  // namespace fw::scene
