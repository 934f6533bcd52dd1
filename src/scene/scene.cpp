#include "scene/scene.hpp"

#include "scene/attachments.hpp"
#include "scene/explicit_system.hpp"
#include "scene/generated_system.hpp"
#include "settings/description.hpp"
#include "settings/reader.hpp"

namespace fw::scene {
namespace {

/// The sections say in what way the scene is given, which is told before anything else.
void check_sections(const CheckedTable& root) {
  const bool is_generated = root.has("generate");
  for (const char* section : {"particles", "springs"}) {
    if (root.has(section) && is_generated) {
      root.fail(section, std::string("found [") + section + "] beside [generate], expected one of them");
    }
  }
  if (root.has("constraint")) root.fail("constraint", "constraints are not available in this version");
  if (is_generated || root.has("particles")) return;
  const settings::SectionDescription description = settings::describe<SceneSpec>({.name = "scene"});
  std::vector<std::string> known;
  for (const settings::SettingDescription& setting : description.settings) known.push_back(setting.info.name);
  for (const settings::SectionDescription& section : description.sections) known.push_back(section.info.name);
  root.fail_missing("particles", "a section [particles] or [generate]", known);
}

Scene build_scene(const CheckedTable& root) {
  check_sections(root);
  SceneSpec spec;
  SceneFile file{root, settings::read(root, spec)};
  Scene scene;
  scene.title = spec.title;
  scene.starts_at_equilibrium = spec.start == "equilibrium";
  scene.model.gravity = spec.world.gravity;
  scene.model.drag = spec.world.drag;
  std::vector<PointGroup> groups = common_groups();
  if (spec.generate) {
    groups = build_generated_system(*spec.generate, file, scene);
  } else {
    build_explicit_system(spec, file, scene);
  }
  add_anchors(spec.anchors, groups, file, scene);
  add_forces(spec.forces, groups, file, scene);
  add_obstacles(spec.obstacles, file, scene);
  if (spec.world.rayleigh) add_rayleigh_damping(*spec.world.rayleigh, scene);
  scene.resolved_toml = file.resolved.text();
  return scene;
}

}  // namespace

Scene read_scene(const std::filesystem::path& path) {
  return build_scene(CheckedTable::parse_file(path));
}

Scene parse_scene(std::string_view text, std::string name) {
  return build_scene(CheckedTable::parse_text(text, std::move(name)));
}

Scene read_scene(const CheckedTable& document) {
  return build_scene(document);
}

Vector initial_state(const Scene& scene) {
  Vector y(scene.position.size() + scene.velocity.size());
  y << scene.position, scene.velocity;
  return y;
}

}  // namespace fw::scene
