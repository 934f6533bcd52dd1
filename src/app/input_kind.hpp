#pragma once

#include <filesystem>

#include "scene/scene.hpp"
#include "text/checked_table.hpp"

namespace fw::app {

/// What a TOML file is, by its keys: a study has `kind`, a scene [particles], [generate] or [[body]].
enum class InputKind { study, scene, unknown };
InputKind input_kind(const CheckedTable& file);

/// The scene in a file that `command` ("simulate") was given. Throws InputError, which for a study says what runs it.
scene::Scene read_scene_for(const std::filesystem::path& path, const std::string& command);

/// Throws InputError if the file, which should be a study, is a scene, and says what takes it.
void refuse_scene(const CheckedTable& file, const std::string& path);

}  // namespace fw::app
