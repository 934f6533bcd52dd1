#pragma once

#include "scene/point_groups.hpp"
#include "scene/scene.hpp"
#include "scene/scene_file.hpp"
#include "scene/scene_spec.hpp"

namespace fw::scene {

/// Adds the sections [[anchor]]: springs from particles to points that stand or move [Zachmann 2011, S37]. InputError where
/// their values do not fit each other.
void add_anchors(const std::vector<AnchorSpec>& anchors, const std::vector<PointGroup>& groups,
                 SceneFile& file, Scene& scene);

/// Adds the sections [[force]].
void add_forces(const std::vector<ForceSpec>& forces, const std::vector<PointGroup>& groups,
                const SceneFile& file, Scene& scene);

/// Adds Rayleigh damping C = α M + β K as the forces of particles and springs that have it (decision 0084):
/// −α m v, and dampers that gain β times the rate of their spring or anchor.
void add_rayleigh_damping(const RayleighSpec& rayleigh, Scene& scene);

/// Adds the sections [[obstacle]]: planes, spheres and boxes with penalty forces [Zachmann 2011, S9].
void add_obstacles(const std::vector<ObstacleSpec>& obstacles, const SceneFile& file, Scene& scene);

}  // namespace fw::scene
