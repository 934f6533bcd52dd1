#include "app/input_kind.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"

namespace fw::app {

InputKind input_kind(const CheckedTable& file) {
  const std::vector<std::string> keys = file.keys();
  const auto has = [&keys](const char* key) { return std::ranges::find(keys, key) != keys.end(); };
  if (has("kind")) return InputKind::study;
  if (has("particles") || has("generate") || has("body")) return InputKind::scene;
  return InputKind::unknown;
}

scene::Scene read_scene_for(const std::filesystem::path& path, const std::string& command) {
  const CheckedTable file = CheckedTable::parse_file(path);
  if (input_kind(file) == InputKind::study) {
    throw InputError(
        fmt::format("{}: found a study (it has the key \"kind\"), {} expects a scene; \"federwerk run {}\" "
                    "runs the study",
                    path.string(), command, path.string()));
  }
  return scene::read_scene(file);
}

void refuse_scene(const CheckedTable& file, const std::string& path) {
  if (input_kind(file) != InputKind::scene) return;
  throw InputError(fmt::format(
      "{}: found a scene, run expects a study (a file with the key \"kind\"); \"federwerk simulate {} "
      "--method NAME --step H --t-end T\" runs the scene",
      path, path));
}

}  // namespace fw::app
