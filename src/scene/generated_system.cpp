#include "scene/generated_system.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/explicit_system.hpp"

namespace fw::scene {
namespace {

/// The neighbours of a family of springs.
std::vector<std::array<int, 3>> offsets_of(const std::string& kind, const std::string& family) {
  if (kind == "block") return kuhn_edge_offsets();
  if (family == "shear") return shear_offsets();
  if (family == "bend") return bend_offsets();
  return family == "cross_brace" ? cross_brace_offsets() : structural_offsets();
}

/// The points along each axis.
std::array<int, 3> counts_of(const GenerateSpec& spec) {
  std::array<int, 3> counts{1, 1, 1};
  if (spec.kind == "chain") {
    counts[0] = static_cast<int>(spec.count);
    return counts;
  }
  for (std::size_t a = 0; a < spec.counts.size(); ++a) counts[a] = static_cast<int>(spec.counts[a]);
  return counts;
}

void check_particle_count(const GenerateSpec& spec, const CheckedTable& table,
                          const std::array<int, 3>& counts) {
  const double points = 1.0 * counts[0] * counts[1] * counts[2];
  if (points > max_particle_count) {
    table.fail(spec.kind == "chain" ? "count" : "counts",
               fmt::format("found {:.4g} particles, expected at most {:.0f}", points,
                           std::floor(max_particle_count)));
  }
}

/// The lengths of the edges.
std::array<double, 3> size_of(const GenerateSpec& spec, const std::array<int, 3>& counts) {
  std::array<double, 3> size{};
  if (spec.spacing) {
    for (std::size_t a = 0; a < 3; ++a) size[a] = *spec.spacing * (counts[a] - 1);
  } else if (spec.kind == "chain") {
    size[0] = *spec.length;
  } else {
    std::copy(spec.size->begin(), spec.size->end(), size.begin());
  }
  return size;
}

Lattice lattice_of(const GenerateSpec& spec, const CheckedTable& table) {
  Lattice lattice;
  lattice.counts = counts_of(spec);
  check_particle_count(spec, table, lattice.counts);
  lattice.origin = spec.origin;
  const std::array<double, 3> size = size_of(spec, lattice.counts);
  if (spec.kind == "chain") {
    // Scaled first, so that the norm of a very short or long direction neither vanishes nor overflows.
    const Vec3<double>& direction = spec.direction;
    const double largest = std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
    if (largest == 0.0) table.fail("direction", "found the zero vector, expected a direction");
    const Vec3<double> scaled{direction.x / largest, direction.y / largest, direction.z / largest};
    lattice.extent[0] = (size[0] / norm(scaled)) * scaled;
  } else if (spec.kind == "cloth") {
    const std::array<Vec3<double>, 3> unit{{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
    lattice.extent[0] = size[0] * unit[static_cast<std::size_t>(spec.plane[0] - 'x')];
    lattice.extent[1] = size[1] * unit[static_cast<std::size_t>(spec.plane[1] - 'x')];
  } else {
    lattice.extent = {{{size[0], 0.0, 0.0}, {0.0, size[1], 0.0}, {0.0, 0.0, size[2]}}};
  }
  return lattice;
}

/// The number of a family: that for all, or its own; nothing where a table leaves it out.
std::optional<double> number_of(const NumberTable& numbers, const std::string& family) {
  for (const std::string& name : {std::string(), family}) {
    if (const auto entry = numbers.find(name); entry != numbers.end()) return entry->second;
  }
  return std::nullopt;
}

std::vector<SpringFamily> families_of(const GenerateSpec& spec, const CheckedTable& table,
                                      TomlTree resolved) {
  const std::vector<std::string>& names = *spec.springs;
  std::vector<SpringFamily> families;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const auto here = names.begin() + static_cast<std::ptrdiff_t>(k);
    if (std::find(names.begin(), here, names[k]) != here) {
      table.fail("springs", {k}, fmt::format("found \"{}\" again, expected each name once", names[k]));
    }
    const std::optional<double> stiffness = number_of(*spec.stiffness, names[k]);
    if (!stiffness) table.table("stiffness").fail_missing(names[k], "a number", names);
    const std::optional<double> damping = number_of(*spec.damping, names[k]);
    if (!damping) resolved.table("damping").set(names[k], 0.0);
    families.push_back({offsets_of(spec.kind, names[k]), *stiffness, damping.value_or(0.0)});
  }
  return families;
}

mechanics::Springs springs_of(const GenerateSpec& spec, const CheckedTable& table, const Lattice& lattice,
                              const std::vector<SpringFamily>& families, const Vector& position) {
  const double factor = spec.rest_length_factor;
  mechanics::Springs springs = lattice_springs(lattice, position, families, spec.law, factor);
  const bool usable = std::all_of(springs.rest_length.begin(), springs.rest_length.end(),
                                  [&](double l) { return std::isfinite(l) && (l > 0.0 || factor == 0.0); });
  if (!usable) {
    table.fail("",
               "found points that coincide or lie too far apart in double precision, expected springs of "
               "finite length > 0");
  }
  return springs;
}

/// `mass` (of every particle), `total_mass` or `density`.
std::vector<double> mass_of(const GenerateSpec& spec, const CheckedTable& table, const Lattice& lattice) {
  if (spec.mass) return for_each_of(lattice.point_count(), *spec.mass);
  const double density = spec.density ? *spec.density : *spec.total_mass / covered_measure(lattice);
  auto mass = spec.kind == "block" ? tetrahedron_lumped_masses(lattice, density)
                                   : cell_lumped_masses(lattice, density);
  if (!std::all_of(mass.begin(), mass.end(), [](double m) { return std::isfinite(m) && m > 0.0; })) {
    table.fail(spec.density ? "density" : "total_mass",
               "found masses that vanish or overflow in double precision, expected finite masses > 0");
  }
  return mass;
}

}  // namespace

std::vector<PointGroup> build_generated_system(const GenerateSpec& spec, SceneFile& file, Scene& scene) {
  const CheckedTable table = file.root.table("generate");
  const Lattice lattice = lattice_of(spec, table);
  const std::vector<SpringFamily> families = families_of(spec, table, file.resolved.table("generate"));
  const double count = count_springs(lattice.counts, families);
  if (count > max_spring_count) {
    table.fail("springs",
               fmt::format("found {:.4g} springs, expected at most {:.0f}", count, max_spring_count));
  }
  scene.position = lattice_positions(lattice);
  if (!scene.position.allFinite()) {
    table.fail("", "found positions that overflow, expected finite positions");
  }
  scene.model.mass = mass_of(spec, table, lattice);
  scene.model.springs = springs_of(spec, table, lattice, families, scene.position);

  const std::vector<PointGroup> groups = groups_of(spec.kind, lattice);
  scene.model.fixed = select_points(spec.pinned, table, "pinned", lattice.point_count(), groups);
  scene.velocity.resize(scene.position.size());
  for (Index i = 0; i < scene.velocity.size() / 3; ++i) store3(scene.velocity.data(), i, spec.velocity);
  for (const int i : scene.model.fixed) store3(scene.velocity.data(), i, Vec3<double>{});
  return groups;
}

}  // namespace fw::scene
