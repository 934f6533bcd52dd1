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

void read_fixed(const CheckedTable& particles, std::size_t count, Scene& scene) {
  if (!particles.has("fixed")) {
    particles.record_default("fixed", std::vector<int>{});
    return;
  }
  scene.model.fixed = particles.indices("fixed", count, "particle");
  std::vector<char> seen(count, 0);
  for (std::size_t k = 0; k < scene.model.fixed.size(); ++k) {
    char& here = seen[static_cast<std::size_t>(scene.model.fixed[k])];
    if (here) {
      particles.fail(
          "fixed", {k},
          fmt::format("found particle {} again, expected each particle once", scene.model.fixed[k]));
    }
    here = 1;
  }
}

void read_velocity(const CheckedTable& particles, std::size_t count, Scene& scene) {
  if (!particles.has("velocity")) {
    scene.velocity = Vector::Zero(scene.position.size());
    particles.record_default("velocity", std::vector<Vec3<double>>(count));
    return;
  }
  auto velocity = particles.vectors("velocity");
  if (velocity.size() != count) {
    particles.fail("velocity",
                   fmt::format("found an array of length {}, expected one vector per particle ({})",
                               velocity.size(), count));
  }
  for (const int i : scene.model.fixed) {
    auto& v = velocity[static_cast<std::size_t>(i)];
    if (v == Vec3<double>{}) continue;
    scene.warnings.push_back(fmt::format("{}: velocity of fixed particle {} is ignored",
                                         particles.where("velocity", {static_cast<std::size_t>(i)}), i));
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

void read_rest_length(const CheckedTable& table, const Vector& position, mechanics::Springs& springs) {
  const std::vector<double> lengths = spring_lengths(table, springs, position);
  if (!table.has("rest_length")) {
    for (std::size_t k = 0; k < lengths.size(); ++k) {
      if (lengths[k] > 0.0) continue;
      table.fail(
          "between", {k},
          fmt::format("found particles {} and {} at the same point, expected a rest_length for such a spring",
                      springs.first[k], springs.second[k]));
    }
    springs.rest_length = lengths;
    table.record_default("rest_length", lengths);
    return;
  }
  const auto rule =
      springs.law == mechanics::SpringLaw::strain ? NumberRule::positive : NumberRule::nonnegative;
  springs.rest_length = table.number_or_list("rest_length", springs.size(), "spring", rule);
}

/// One section [springs] or [[springs]].
mechanics::Springs read_spring_section(const CheckedTable& table, const Scene& scene) {
  mechanics::Springs springs;
  const auto between = table.index_pairs("between", scene.model.mass.size(), "particle");
  const std::size_t count = between.size();
  springs.first.reserve(count);
  springs.second.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    const auto [i, j] = between[k];
    if (i == j) {
      table.fail(
          "between", {k},
          fmt::format("found a spring from particle {} to itself, expected two different particles", i));
    }
    springs.first.push_back(i);
    springs.second.push_back(j);
  }
  springs.law = read_spring_law(table);
  springs.stiffness = count > 0
                          ? table.number_or_list("stiffness", count, "spring", NumberRule::nonnegative)
                          : table.number_or_list_or("stiffness", 0.0, 0, "spring", NumberRule::nonnegative);
  springs.damping = table.number_or_list_or("damping", 0.0, count, "spring", NumberRule::nonnegative);
  read_rest_length(table, scene.position, springs);
  return springs;
}

/// The sections [[springs]], group after group.
void read_spring_groups(const CheckedTable& root, Scene& scene) {
  mechanics::Springs& springs = scene.model.springs;
  const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  for (const CheckedTable& table : root.tables("springs")) {
    const mechanics::Springs group = read_spring_section(table, scene);
    const std::string name = table.string_or("name", "");
    for (const mechanics::SpringGroup& earlier : springs.groups) {
      if (!name.empty() && earlier.name == name) {
        table.fail("name", fmt::format("found \"{}\" again, expected each name once", name));
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

mechanics::SpringLaw read_spring_law(const CheckedTable& table) {
  const std::string law = table.choice_or("law", "hooke", {"hooke", "strain", "tension_only"});
  if (law == "strain") return mechanics::SpringLaw::strain;
  return law == "tension_only" ? mechanics::SpringLaw::tension_only : mechanics::SpringLaw::hooke;
}

void read_explicit_system(const CheckedTable& root, Scene& scene) {
  const CheckedTable particles = root.table("particles");
  const auto position = particles.vectors("position");
  const std::size_t count = position.size();
  if (count == 0) particles.fail("position", "found an empty array, expected at least one particle");
  if (static_cast<double>(count) > max_particle_count) {
    particles.fail("position", fmt::format("found {} particles, expected at most {:.0f}", count,
                                           std::floor(max_particle_count)));
  }
  scene.position = flattened(position);
  scene.model.mass = particles.number_or_list("mass", count, "particle", NumberRule::positive);
  read_fixed(particles, count, scene);
  read_velocity(particles, count, scene);
  if (!root.has("springs")) return;
  if (root.is_table("springs")) {
    scene.model.springs = read_spring_section(root.table("springs"), scene);
  } else {
    read_spring_groups(root, scene);
  }
}

}  // namespace fw::scene
