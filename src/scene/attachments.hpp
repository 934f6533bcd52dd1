#pragma once

#include "scene/point_groups.hpp"
#include "scene/scene.hpp"
#include "scene/scene_file.hpp"
#include "scene/scene_spec.hpp"

namespace fw::scene {

/// Adds the sections [[anchor]]: springs from particles to points at rest [Zachmann 2011, S37]. InputError where
/// their values do not fit each other.
void add_anchors(const std::vector<AnchorSpec>& anchors, const std::vector<PointGroup>& groups,
                 SceneFile& file, Scene& scene);

/// Adds the sections [[obstacle]]: planes, spheres and boxes with penalty forces [Zachmann 2011, S9].
void add_obstacles(const std::vector<ObstacleSpec>& obstacles, const SceneFile& file, Scene& scene);

}  // namespace fw::scene
