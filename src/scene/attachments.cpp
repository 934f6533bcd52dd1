#include "scene/attachments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "mechanics/elements/spring_force.hpp"

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

/// Which particles are fixed.
std::vector<char> fixed_particles(const Scene& scene) {
  std::vector<char> fixed(scene.model.mass.size(), 0);
  for (const int i : scene.model.fixed) fixed[static_cast<std::size_t>(i)] = 1;
  return fixed;
}

/// Warns where something acts on fixed particles.
void warn_of_fixed(const std::vector<int>& particles, const CheckedTable& table, const char* verb,
                   const char* what, Scene& scene) {
  const std::vector<char> fixed = fixed_particles(scene);
  const auto without_effect =
      std::ranges::count_if(particles, [&](int i) { return fixed[static_cast<std::size_t>(i)] != 0; });
  if (without_effect == 0) return;
  scene.warnings.push_back(fmt::format("{}: {} of the {} {} particles {} fixed: there the {} has no effect",
                                       table.where(), without_effect, particles.size(), verb,
                                       without_effect == 1 ? "is" : "are", what));
}

formula::VectorFunction function_of(const TimeTableSpec& table, const CheckedTable& section) {
  try {
    return formula::VectorFunction(formula::TableFunction{table.t, table.value});
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", section.table("table").where(), error.what()));
  }
}

formula::VectorFunction function_of(const std::vector<std::string>& texts, const CheckedTable& section) {
  const auto parsed = [&](std::size_t component) {
    try {
      return formula::Expression(texts[component]);
    } catch (const InputError& error) {
      section.fail("expression", {component}, error.what());
    }
  };
  formula::ExpressionFunction expressions{parsed(0), parsed(1), parsed(2)};
  for (std::size_t c = 0; c < 3; ++c) {
    const formula::Jet<double> start = expressions[c](0.0);
    if (std::isfinite(start.value) && std::isfinite(start.rate)) continue;
    section.fail(
        "expression", {c},
        fmt::format("\"{}\": found the value {} and the derivative {} at t = 0, expected finite numbers",
                    texts[c], start.value, start.rate));
  }
  return formula::VectorFunction(std::move(expressions));
}

/// The function that a section gives in one of three forms, of which `key` is the one with a single vector;
/// `line` makes a function of that. Nothing where there is none.
template <class Line>
std::optional<formula::VectorFunction> function_of(const TimeFunctionSpec& spec, const char* key,
                                                   const CheckedTable& section, Line line) {
  std::vector<std::string> given;
  if (spec.vector) given.emplace_back(key);
  if (spec.table) given.emplace_back("table");
  if (spec.expression) given.emplace_back("expression");
  if (given.empty()) return std::nullopt;
  if (given.size() > 1) {
    section.fail(given[1],
                 fmt::format("found it beside \"{}\", expected one of \"{}\", \"table\", \"expression\"",
                             given[0], key));
  }
  if (spec.vector) return formula::VectorFunction(line(*spec.vector));
  return spec.table ? function_of(*spec.table, section) : function_of(*spec.expression, section);
}

}  // namespace

void add_anchors(const std::vector<AnchorSpec>& anchors, const std::vector<PointGroup>& groups,
                 SceneFile& file, Scene& scene) {
  const std::size_t count = scene.model.mass.size();
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
    std::vector<int> numbers;
    for (const int i : particles) {
      const Vec3<double> rest = anchor.position.value_or(load3(scene.position.data(), i));
      numbers.push_back(static_cast<int>(scene.model.anchors.size()));
      scene.model.anchors.push_back({i, rest, anchor.stiffness, anchor.damping});
    }
    auto displacement = function_of(anchor.displacement, "velocity", table, [](const Vec3<double>& velocity) {
      return formula::LinearFunction{.offset = {}, .slope = velocity};
    });
    if (displacement) scene.model.support_motions.push_back({std::move(numbers), std::move(*displacement)});
    warn_of_fixed(particles, table, "anchored", "anchor", scene);
  }
}

void add_forces(const std::vector<ForceSpec>& forces, const std::vector<PointGroup>& groups,
                const SceneFile& file, Scene& scene) {
  const std::vector<CheckedTable> tables = file.root.tables("force");
  for (std::size_t k = 0; k < forces.size(); ++k) {
    const CheckedTable& table = tables[k];
    auto particles = select_points(forces[k].particle, table, "particle", scene.model.mass.size(), groups);
    if (particles.empty()) table.fail("particle", "found no particle, expected at least one");
    auto force = function_of(forces[k].force, "value", table, [](const Vec3<double>& value) {
      return formula::LinearFunction{.offset = value, .slope = {}};
    });
    if (!force) {
      throw InputError(fmt::format(
          "{}: found none of \"value\", \"table\", \"expression\", expected exactly one", table.where()));
    }
    warn_of_fixed(particles, table, "driven", "force", scene);
    scene.model.forces.push_back({std::move(particles), std::move(*force)});
  }
}

void add_rayleigh_damping(const RayleighSpec& rayleigh, Scene& scene) {
  mechanics::MassSpringModel& model = scene.model;
  model.mass_drag = rayleigh.mass;
  if (rayleigh.stiffness == 0.0) return;
  model.springs.for_each_group([&](const mechanics::SpringGroup& group, std::size_t begin) {
    mechanics::with_spring_law(group.law, [&](auto law) {
      for (std::size_t e = begin; e < begin + group.size; ++e) {
        const auto spring = mechanics::spring_parameters(model.springs, e);
        if (spring.stiffness > 0.0) {
          model.springs.damping[e] += rayleigh.stiffness * mechanics::spring_rate<law()>(spring);
        }
      }
    });
  });
  for (mechanics::Anchor& anchor : model.anchors) anchor.damping += rayleigh.stiffness * anchor.stiffness;
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
