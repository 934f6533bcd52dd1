#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "scene/scene.hpp"

namespace fw::scene {

/// Reads a scene file (TOML; docs/scene_format.md). InputError with file, line, key and index for everything
/// that is unknown, missing, of the wrong type, size or sign; nothing is ignored silently.
Scene read_scene(const std::filesystem::path& path);

/// The same for a text; `name` stands for the file in messages.
Scene parse_scene(std::string_view text, std::string name);

}  // namespace fw::scene
