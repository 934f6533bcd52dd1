#pragma once

#include "scene/scene.hpp"
#include "scene/scene_file.hpp"
#include "scene/scene_spec.hpp"

namespace fw::scene {

/// States have 6 entries per particle and are indexed with 32 bits in sparse matrices.
inline constexpr double max_particle_count = 2147483647.0 / 6.0;
/// Springs are counted with 32 bits.
inline constexpr double max_spring_count = 2147483647.0;

/// Builds the particles of the section [particles] and the springs of [springs] or the sections [[springs]].
/// InputError where their values do not fit each other.
void build_explicit_system(const SceneSpec& spec, SceneFile& file, Scene& scene);

}  // namespace fw::scene
