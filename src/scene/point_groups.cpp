#include "scene/point_groups.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fw::scene {
namespace {

/// A group given by the position in the lattice: −1 first, +1 last, 0 between, along each axis.
template <class Predicate>
PointGroup lattice_group(const Lattice& lattice, std::string name, Predicate predicate) {
  const auto counts = lattice.counts;
  return {std::move(name), [counts, predicate](int index) {
            const auto end = [](int i, int count) { return i == 0 ? -1 : i == count - 1 ? 1 : 0; };
            return predicate(end(index % counts[0], counts[0]), end(index / counts[0] % counts[1], counts[1]),
                             end(index / counts[0] / counts[1], counts[2]));
          }};
}

}  // namespace

std::vector<PointGroup> common_groups() {
  return {{"all", [](int) { return true; }}};
}

std::vector<PointGroup> line_groups(const Lattice& lattice) {
  auto groups = common_groups();
  const auto add = [&](const char* name, auto predicate) {
    groups.push_back(lattice_group(lattice, name, predicate));
  };
  add("start", [](int u, int, int) { return u < 0; });
  add("end", [](int u, int, int) { return u > 0; });
  add("ends", [](int u, int, int) { return u != 0; });
  return groups;
}

std::vector<PointGroup> sheet_groups(const Lattice& lattice) {
  auto groups = common_groups();
  const auto add = [&](const char* name, auto predicate) {
    groups.push_back(lattice_group(lattice, name, predicate));
  };
  add("left_edge", [](int u, int, int) { return u < 0; });
  add("right_edge", [](int u, int, int) { return u > 0; });
  add("bottom_edge", [](int, int v, int) { return v < 0; });
  add("top_edge", [](int, int v, int) { return v > 0; });
  add("boundary", [](int u, int v, int) { return u != 0 || v != 0; });
  add("bottom_left", [](int u, int v, int) { return u < 0 && v < 0; });
  add("bottom_right", [](int u, int v, int) { return u > 0 && v < 0; });
  add("top_left", [](int u, int v, int) { return u < 0 && v > 0; });
  add("top_right", [](int u, int v, int) { return u > 0 && v > 0; });
  add("top_corners", [](int u, int v, int) { return u != 0 && v > 0; });
  add("bottom_corners", [](int u, int v, int) { return u != 0 && v < 0; });
  add("corners", [](int u, int v, int) { return u != 0 && v != 0; });
  return groups;
}

std::vector<PointGroup> box_groups(const Lattice& lattice) {
  auto groups = common_groups();
  const auto add = [&](const char* name, auto predicate) {
    groups.push_back(lattice_group(lattice, name, predicate));
  };
  add("left_face", [](int x, int, int) { return x < 0; });
  add("right_face", [](int x, int, int) { return x > 0; });
  add("front_face", [](int, int y, int) { return y < 0; });
  add("back_face", [](int, int y, int) { return y > 0; });
  add("bottom_face", [](int, int, int z) { return z < 0; });
  add("top_face", [](int, int, int z) { return z > 0; });
  add("boundary", [](int x, int y, int z) { return x != 0 || y != 0 || z != 0; });
  add("bottom_corners", [](int x, int y, int z) { return x != 0 && y != 0 && z < 0; });
  add("top_corners", [](int x, int y, int z) { return x != 0 && y != 0 && z > 0; });
  add("corners", [](int x, int y, int z) { return x != 0 && y != 0 && z != 0; });
  return groups;
}

std::vector<PointGroup> groups_of(const std::string& kind, const Lattice& lattice) {
  if (kind == "chain") return line_groups(lattice);
  if (kind == "cloth") return sheet_groups(lattice);
  if (kind == "grid" || kind == "block") return box_groups(lattice);
  return common_groups();
}

std::vector<int> select_points(const PointList& entries, const CheckedTable& table, std::string_view key,
                               std::size_t particle_count, const std::vector<PointGroup>& groups) {
  std::vector<char> selected(particle_count, 0), listed(particle_count, 0);
  std::vector<std::string> used;
  for (std::size_t e = 0; e < entries.size(); ++e) {
    if (const int* index = std::get_if<int>(&entries[e])) {
      const auto i = static_cast<std::size_t>(*index);
      if (listed[i])
        table.fail(key, {e}, fmt::format("found particle {} again, expected each particle once", i));
      listed[i] = selected[i] = 1;
      continue;
    }
    const auto& name = std::get<std::string>(entries[e]);
    if (std::find(used.begin(), used.end(), name) != used.end()) {
      table.fail(key, {e}, fmt::format("found \"{}\" again, expected each name once", name));
    }
    used.push_back(name);
    const auto group =
        std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.name == name; });
    for (std::size_t i = 0; i < particle_count; ++i) {
      if (group->contains(static_cast<int>(i))) selected[i] = 1;
    }
  }
  std::vector<int> points;
  for (std::size_t i = 0; i < particle_count; ++i) {
    if (selected[i]) points.push_back(static_cast<int>(i));
  }
  return points;
}

}  // namespace fw::scene
