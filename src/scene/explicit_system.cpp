#include "scene/explicit_system.hpp"

#include <fmt/format.h>

#include <cmath>

namespace fw::scene {
namespace {

Vector flattened(const std::vector<Vec3<double>>& vectors) {
  Vector result(3 * static_cast<Index>(vectors.size()));
  for (std::size_t i = 0; i < vectors.size(); ++i) store3(result.data(), static_cast<Index>(i), vectors[i]);
  return result;
}

void check_fixed(const std::vector<int>& fixed, std::size_t count, const CheckedTable& table) {
  std::vector<char> seen(count, 0);
  for (std::size_t k = 0; k < fixed.size(); ++k) {
    char& here = seen[static_cast<std::size_t>(fixed[k])];
    if (here) {
      table.fail("fixed", {k}, fmt::format("found particle {} again, expected each particle once", fixed[k]));
    }
    here = 1;
  }
}

void set_velocity(const ParticlesSpec& particles, const CheckedTable& table, TomlTree resolved,
                  Scene& scene) {
  const std::size_t count = particles.position.size();
  if (!particles.velocity) {
    scene.velocity = Vector::Zero(scene.position.size());
    resolved.set("velocity", std::vector<Vec3<double>>(count));
    return;
  }
  auto velocity = *particles.velocity;
  if (velocity.size() != count) {
    table.fail("velocity", fmt::format("found an array of length {}, expected one vector per particle ({})",
                                       velocity.size(), count));
  }
  for (const int i : scene.model.fixed) {
    auto& v = velocity[static_cast<std::size_t>(i)];
    if (v == Vec3<double>{}) continue;
    scene.warnings.push_back(fmt::format("{}: velocity of fixed particle {} is ignored",
                                         table.where("velocity", {static_cast<std::size_t>(i)}), i));
    v = {};
  }
  scene.velocity = flattened(velocity);
}

/// ‖x_j − x_i‖ of every spring.
std::vector<double> spring_lengths(const CheckedTable& table, const mechanics::Springs& springs,
                                   const Vector& position) {
  std::vector<double> lengths(springs.size());
  for (std::size_t k = 0; k < springs.size(); ++k) {
    const int i = springs.first[k], j = springs.second[k];
    lengths[k] = norm(load3(position.data(), j) - load3(position.data(), i));
    if (!std::isfinite(lengths[k])) {
      table.fail(
          "between", {k},
          fmt::format("found particles {} and {} so far apart that their distance overflows, expected a "
                      "finite distance",
                      i, j));
    }
  }
  return lengths;
}

/// The given lengths, or the distances at the start.
std::vector<double> rest_lengths(const SpringsSpec& spec, const CheckedTable& table, TomlTree resolved,
                                 const Vector& position, const mechanics::Springs& springs) {
  const std::vector<double> lengths = spring_lengths(table, springs, position);
  if (spec.rest_length) return for_each_of(springs.size(), *spec.rest_length);
  for (std::size_t k = 0; k < lengths.size(); ++k) {
    if (lengths[k] > 0.0) continue;
    table.fail(
        "between", {k},
        fmt::format("found particles {} and {} at the same point, expected a rest_length for such a spring",
                    springs.first[k], springs.second[k]));
  }
  resolved.set("rest_length", lengths);
  return lengths;
}

/// One section [springs] or [[springs]].
mechanics::Springs springs_of(const SpringsSpec& spec, const CheckedTable& table, TomlTree resolved,
                              const Vector& position) {
  mechanics::Springs springs;
  const std::size_t count = spec.between.size();
  springs.first.reserve(count);
  springs.second.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    const auto [i, j] = spec.between[k];
    if (i == j) {
      table.fail(
          "between", {k},
          fmt::format("found a spring from particle {} to itself, expected two different particles", i));
    }
    springs.first.push_back(i);
    springs.second.push_back(j);
  }
  springs.law = spec.law;
  springs.stiffness = for_each_of(count, spec.stiffness);
  springs.damping = for_each_of(count, spec.damping);
  springs.rest_length = rest_lengths(spec, table, std::move(resolved), position, springs);
  return springs;
}

/// The sections [[springs]], group after group.
void add_spring_groups(const std::vector<SpringGroupSpec>& groups, SceneFile& file, Scene& scene) {
  if (groups.empty()) return;
  mechanics::Springs& springs = scene.model.springs;
  const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  const std::vector<CheckedTable> tables = file.root.tables("springs");
  for (std::size_t k = 0; k < groups.size(); ++k) {
    const mechanics::Springs group =
        springs_of(groups[k].springs, tables[k], file.resolved.table("springs", k), scene.position);
    const std::string& name = groups[k].name;
    for (const mechanics::SpringGroup& earlier : springs.groups) {
      if (!name.empty() && earlier.name == name) {
        tables[k].fail("name", fmt::format("found \"{}\" again, expected each name once", name));
      }
    }
    append(springs.first, group.first);
    append(springs.second, group.second);
    append(springs.stiffness, group.stiffness);
    append(springs.damping, group.damping);
    append(springs.rest_length, group.rest_length);
    springs.groups.push_back({name, group.law, group.size()});
  }
}

}  // namespace

void build_explicit_system(const SceneSpec& spec, SceneFile& file, Scene& scene) {
  const ParticlesSpec& particles = *spec.particles;
  const CheckedTable table = file.root.table("particles");
  const std::size_t count = particles.position.size();
  if (static_cast<double>(count) > max_particle_count) {
    table.fail("position", fmt::format("found {} particles, expected at most {:.0f}", count,
                                       std::floor(max_particle_count)));
  }
  scene.position = flattened(particles.position);
  scene.model.mass = for_each_of(count, particles.mass);
  check_fixed(particles.fixed, count, table);
  scene.model.fixed = particles.fixed;
  set_velocity(particles, table, file.resolved.table("particles"), scene);
  if (spec.springs) {
    scene.model.springs =
        springs_of(*spec.springs, file.root.table("springs"), file.resolved.table("springs"), scene.position);
  }
  add_spring_groups(spec.spring_groups, file, scene);
}

}  // namespace fw::scene
