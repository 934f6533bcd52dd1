#include "scene/generated_system.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/explicit_system.hpp"
#include "scene/generators.hpp"

namespace fw::scene {
namespace {

constexpr std::int64_t largest_count = 2147483647;

struct NamedOffsets {
  std::string name;
  std::vector<std::array<int, 3>> offsets;
};

/// What the kinds of [generate] differ in.
struct Kind {
  std::string name;
  std::vector<NamedOffsets> families;
  std::vector<std::string> default_springs;
};

Kind make_kind(const std::string& name) {
  if (name == "chain") {
    return {name, {{"structural", structural_offsets()}, {"bend", bend_offsets()}}, {"structural"}};
  }
  if (name == "cloth") {
    return {name,
            {{"structural", structural_offsets()}, {"shear", shear_offsets()}, {"bend", bend_offsets()}},
            {"structural", "shear", "bend"}};
  }
  if (name == "grid") {
    return {name,
            {{"structural", structural_offsets()},
             {"shear", shear_offsets()},
             {"bend", bend_offsets()},
             {"cross_brace", cross_brace_offsets()}},
            {"structural", "shear"}};
  }
  return {name, {{"structural", kuhn_edge_offsets()}}, {"structural"}};
}

Kind read_kind(const CheckedTable& generate) {
  std::vector<std::string> names;
  for (const GeneratorInfo& generator : generators()) names.push_back(generator.name);
  names.emplace_back("mesh");
  const std::string name = generate.choice("kind", names);
  if (name == "mesh") {
    generate.fail("kind",
                  "found \"mesh\", expected one of \"chain\", \"cloth\", \"grid\", \"block\": meshes are not "
                  "available in this version");
  }
  return make_kind(name);
}

/// The points per axis of a cloth (2 numbers), grid or block (3).
std::array<int, 3> read_counts(const CheckedTable& generate, std::size_t axes) {
  const auto counts = generate.integers("counts", 2, largest_count);
  if (counts.size() != axes) {
    generate.fail("counts",
                  fmt::format("found an array of length {}, expected the numbers of points along {} axes",
                              counts.size(), axes));
  }
  std::array<int, 3> result{1, 1, 1};
  for (std::size_t a = 0; a < axes; ++a) result[a] = static_cast<int>(counts[a]);
  return result;
}

void check_particle_count(const CheckedTable& generate, const char* key, const std::array<int, 3>& counts) {
  const double points = 1.0 * counts[0] * counts[1] * counts[2];
  if (points > max_particle_count) {
    generate.fail(key, fmt::format("found {:.4g} particles, expected at most {:.0f}", points,
                                   std::floor(max_particle_count)));
  }
}

/// The lengths of the edges of a cloth, grid or block: `size`, or `spacing` of neighbouring points.
std::array<double, 3> read_size(const CheckedTable& generate, const char* key,
                                const std::array<int, 3>& counts, std::size_t axes) {
  std::array<double, 3> size{};
  if (generate.has("spacing")) {
    if (generate.has(key)) {
      generate.fail("spacing", fmt::format("found both \"{}\" and \"spacing\", expected one of them", key));
    }
    const double spacing = generate.positive_number("spacing");
    for (std::size_t a = 0; a < axes; ++a) size[a] = spacing * (counts[a] - 1);
    return size;
  }
  if (!generate.has(key)) {
    generate.fail_missing(key, fmt::format("\"{}\" or \"spacing\" in metres", key));
  }
  if (axes == 1) {
    size[0] = generate.positive_number(key);
    return size;
  }
  const auto values = generate.numbers(key, NumberRule::positive);
  if (values.size() != axes) {
    generate.fail(key, fmt::format("found an array of length {}, expected the lengths of {} edges",
                                   values.size(), axes));
  }
  std::copy(values.begin(), values.end(), size.begin());
  return size;
}

Lattice read_chain(const CheckedTable& generate) {
  Lattice lattice;
  lattice.counts[0] = static_cast<int>(generate.integer("count", 2, largest_count));
  check_particle_count(generate, "count", lattice.counts);
  const double length = read_size(generate, "length", lattice.counts, 1)[0];
  const Vec3<double> direction = generate.vec3_or("direction", {1.0, 0.0, 0.0});
  // Scaled first, so that the norm of a very short or long direction neither vanishes nor overflows.
  const double largest = std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
  if (largest == 0.0) generate.fail("direction", "found the zero vector, expected a direction");
  const Vec3<double> scaled{direction.x / largest, direction.y / largest, direction.z / largest};
  lattice.extent[0] = (length / norm(scaled)) * scaled;
  lattice.origin = generate.vec3_or("origin", {});
  return lattice;
}

Lattice read_cloth(const CheckedTable& generate) {
  Lattice lattice;
  lattice.counts = read_counts(generate, 2);
  check_particle_count(generate, "counts", lattice.counts);
  const auto size = read_size(generate, "size", lattice.counts, 2);
  const std::string plane = generate.choice_or("plane", "xy", {"xy", "xz", "yz"});
  const std::array<Vec3<double>, 3> unit{{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
  lattice.extent[0] = size[0] * unit[static_cast<std::size_t>(plane[0] - 'x')];
  lattice.extent[1] = size[1] * unit[static_cast<std::size_t>(plane[1] - 'x')];
  lattice.origin = generate.vec3_or("origin", {});
  return lattice;
}

Lattice read_box(const CheckedTable& generate) {
  Lattice lattice;
  lattice.counts = read_counts(generate, 3);
  check_particle_count(generate, "counts", lattice.counts);
  const auto size = read_size(generate, "size", lattice.counts, 3);
  lattice.extent = {{{size[0], 0.0, 0.0}, {0.0, size[1], 0.0}, {0.0, 0.0, size[2]}}};
  lattice.origin = generate.vec3_or("origin", {});
  return lattice;
}

/// One value for every family, or a table with one per family.
double read_family_value(const CheckedTable& generate, const char* key, const std::string& family,
                         bool required) {
  const auto read = [&](const CheckedTable& table, std::string_view name) {
    return required ? table.number(name, NumberRule::nonnegative)
                    : table.number_or(name, 0.0, NumberRule::nonnegative);
  };
  return generate.is_table(key) ? read(generate.table(key), family) : read(generate, key);
}

std::vector<SpringFamily> read_families(const CheckedTable& generate, const Kind& kind) {
  std::vector<std::string> allowed;
  for (const auto& family : kind.families) allowed.push_back(family.name);
  const auto names = generate.has("springs") ? generate.choices("springs", allowed)
                                             : generate.strings_or("springs", kind.default_springs);
  std::vector<SpringFamily> families;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (std::find(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(k), names[k]) !=
        names.begin() + static_cast<std::ptrdiff_t>(k)) {
      generate.fail("springs", {k}, fmt::format("found \"{}\" again, expected each name once", names[k]));
    }
    const auto family = std::find_if(kind.families.begin(), kind.families.end(),
                                     [&](const auto& candidate) { return candidate.name == names[k]; });
    families.push_back({family->offsets, read_family_value(generate, "stiffness", names[k], true),
                        read_family_value(generate, "damping", names[k], false)});
  }
  return families;
}

/// The springs of a lattice before any of them is made.
struct SpringPlan {
  std::vector<SpringFamily> families;
  mechanics::SpringLaw law = mechanics::SpringLaw::hooke;
  double rest_length_factor = 1.0;
};

SpringPlan read_spring_plan(const CheckedTable& generate, const Kind& kind, const Lattice& lattice) {
  SpringPlan plan;
  plan.families = read_families(generate, kind);
  const double count = count_springs(lattice.counts, plan.families);
  if (count > max_spring_count) {
    generate.fail("springs",
                  fmt::format("found {:.4g} springs, expected at most {:.0f}", count, max_spring_count));
  }
  plan.law = read_spring_law(generate);
  const auto rule = plan.law == mechanics::SpringLaw::strain ? NumberRule::positive : NumberRule::nonnegative;
  plan.rest_length_factor = generate.number_or("rest_length_factor", 1.0, rule);
  return plan;
}

void make_springs(const CheckedTable& generate, const SpringPlan& plan, const Lattice& lattice,
                  Scene& scene) {
  const double factor = plan.rest_length_factor;
  auto& springs = scene.model.springs;
  springs = lattice_springs(lattice, scene.position, plan.families, plan.law, factor);
  const bool usable = std::all_of(springs.rest_length.begin(), springs.rest_length.end(),
                                  [&](double l) { return std::isfinite(l) && (l > 0.0 || factor == 0.0); });
  if (!usable) {
    generate.fail("",
                  "found points that coincide or lie too far apart in double precision, expected springs of "
                  "finite length > 0");
  }
}

/// `mass` (of every particle), `total_mass` or `density`.
std::vector<double> read_mass(const CheckedTable& generate, const Kind& kind, const Lattice& lattice) {
  std::vector<std::string> given;
  for (const char* key : {"mass", "total_mass", "density"}) {
    if (generate.has(key)) given.emplace_back(key);
  }
  if (given.empty()) generate.fail_missing("mass", "one of \"mass\", \"total_mass\", \"density\"");
  if (given.size() > 1) {
    generate.fail(given[1],
                  fmt::format("found both \"{}\" and \"{}\", expected one of them", given[0], given[1]));
  }
  if (given[0] == "mass") {
    return generate.number_or_list("mass", lattice.point_count(), "particle", NumberRule::positive);
  }
  double density = generate.positive_number(given[0]);
  if (given[0] == "total_mass") density /= covered_measure(lattice);
  auto mass = kind.name == "block" ? tetrahedron_lumped_masses(lattice, density)
                                   : cell_lumped_masses(lattice, density);
  if (!std::all_of(mass.begin(), mass.end(), [](double m) { return std::isfinite(m) && m > 0.0; })) {
    generate.fail(given[0],
                  "found masses that vanish or overflow in double precision, expected finite masses > 0");
  }
  return mass;
}

}  // namespace

std::vector<PointGroup> read_generated_system(const CheckedTable& generate, Scene& scene) {
  const Kind kind = read_kind(generate);
  const Lattice lattice = kind.name == "chain"   ? read_chain(generate)
                          : kind.name == "cloth" ? read_cloth(generate)
                                                 : read_box(generate);
  const SpringPlan plan = read_spring_plan(generate, kind, lattice);
  scene.position = lattice_positions(lattice);
  if (!scene.position.allFinite())
    generate.fail("", "found positions that overflow, expected finite positions");
  scene.model.mass = read_mass(generate, kind, lattice);
  make_springs(generate, plan, lattice, scene);

  const auto groups = kind.name == "chain"   ? line_groups(lattice)
                      : kind.name == "cloth" ? sheet_groups(lattice)
                                             : box_groups(lattice);
  if (generate.has("pinned")) {
    scene.model.fixed = read_points(generate, "pinned", lattice.point_count(), groups);
  } else {
    generate.record_default("pinned", std::vector<int>{});
  }
  const Vec3<double> velocity = generate.vec3_or("velocity", {});
  scene.velocity.resize(scene.position.size());
  for (Index i = 0; i < scene.velocity.size() / 3; ++i) store3(scene.velocity.data(), i, velocity);
  for (const int i : scene.model.fixed) store3(scene.velocity.data(), i, Vec3<double>{});
  return groups;
}

}  // namespace fw::scene
