#pragma once

#include "scene/point_groups.hpp"
#include "scene/scene.hpp"
#include "text/checked_table.hpp"

namespace fw::scene {

/// Reads [generate] and builds the chain, cloth, grid or block that it describes. Returns the names of its
/// points. Checks the size of the system before any memory is taken for it.
std::vector<PointGroup> read_generated_system(const CheckedTable& generate, Scene& scene);

}  // namespace fw::scene
