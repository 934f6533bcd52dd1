#pragma once

#include "scene/point_groups.hpp"
#include "scene/scene.hpp"
#include "scene/scene_file.hpp"
#include "scene/scene_spec.hpp"

namespace fw::scene {

/// Builds the chain, cloth, grid or block that the section [generate] describes. Returns the names of its
/// points. Checks the size of the system before any memory is taken for it. InputError where the values do not
/// fit each other.
std::vector<PointGroup> build_generated_system(const GenerateSpec& generate, SceneFile& file, Scene& scene);

}  // namespace fw::scene
