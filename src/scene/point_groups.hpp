#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/lattice.hpp"
#include "text/toml_tree.hpp"

namespace fw::scene {

/// Particles that a scene file may call by one name.
struct PointGroup {
  std::string name;
  std::function<bool(int)> contains;  ///< of a particle's index
};

/// "all", which every scene has.
std::vector<PointGroup> common_groups();
/// The ends of a line: start, end, ends.
std::vector<PointGroup> line_groups(const Lattice& lattice);
/// The edges and corners of a sheet, with its first axis to the right and its second one up.
std::vector<PointGroup> sheet_groups(const Lattice& lattice);
/// The faces and corners of a box: left/right along x, front/back along y, bottom/top along z.
std::vector<PointGroup> box_groups(const Lattice& lattice);

/// The groups of a lattice of this kind of [generate]; of another name those that every scene has.
std::vector<PointGroup> groups_of(const std::string& kind, const Lattice& lattice);

/// The particles that indices and names of groups say, in ascending order. InputError, which names the entry of
/// `key` in `table`, if an index or name is given twice.
std::vector<int> select_points(const PointList& entries, const CheckedTable& table, std::string_view key,
                               std::size_t particle_count, const std::vector<PointGroup>& groups);

}  // namespace fw::scene
