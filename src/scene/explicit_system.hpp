#pragma once

#include "mechanics/elements/spring_law.hpp"
#include "scene/scene.hpp"
#include "text/checked_table.hpp"

namespace fw::scene {

/// States have 6 entries per particle and are indexed with 32 bits in sparse matrices.
inline constexpr double max_particle_count = 2147483647.0 / 6.0;
/// Springs are counted with 32 bits.
inline constexpr double max_spring_count = 2147483647.0;

/// The `law` of [springs] or [generate], "hooke" by default.
mechanics::SpringLaw read_spring_law(const CheckedTable& table);

/// Reads [particles] and, if there are any, [springs] or the sections [[springs]].
void read_explicit_system(const CheckedTable& root, Scene& scene);

}  // namespace fw::scene
