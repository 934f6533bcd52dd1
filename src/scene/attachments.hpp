#pragma once

#include "scene/point_groups.hpp"
#include "scene/scene.hpp"
#include "text/checked_table.hpp"

namespace fw::scene {

/// Reads the sections [[anchor]]: springs from particles to points at rest [Zachmann 2011, S37].
void read_anchors(const CheckedTable& root, const std::vector<PointGroup>& groups, Scene& scene);

/// Reads the sections [[obstacle]]: planes, spheres and boxes with penalty forces [Zachmann 2011, S9].
void read_obstacles(const CheckedTable& root, Scene& scene);

}  // namespace fw::scene
