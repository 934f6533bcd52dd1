#pragma once

#include <string>

namespace fw::app {

/// What is known of a scene file before a run: masses, stiffest springs, eigenvalues at the start, the largest
/// stable step of common methods there. As text or JSON. Throws InputError as `scene::read_scene` does.
std::string describe_scene(const std::string& file, bool as_json);

}  // namespace fw::app
