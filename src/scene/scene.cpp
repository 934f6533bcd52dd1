#include "scene/scene.hpp"

#include "scene/attachments.hpp"
#include "scene/explicit_system.hpp"
#include "scene/generated_system.hpp"

namespace fw::scene {
namespace {

Scene build_scene(const CheckedTable& root) {
  Scene scene;
  scene.title = root.string_or("title", "");
  const CheckedTable world = root.table_or_empty("world");
  scene.model.gravity = world.vec3_or("gravity", {});
  scene.model.drag = world.number_or("drag", 0.0, NumberRule::nonnegative);

  const bool generated = root.has("generate");
  for (const char* section : {"particles", "springs"}) {
    if (root.has(section) && generated) {
      root.fail(section, std::string("found [") + section + "] beside [generate], expected one of them");
    }
  }
  if (root.has("constraint")) root.fail("constraint", "constraints are not available in this version");

  std::vector<PointGroup> groups;
  if (generated) {
    groups = read_generated_system(root.table("generate"), scene);
  } else {
    if (!root.has("particles")) root.fail_missing("particles", "a section [particles] or [generate]");
    read_explicit_system(root, scene);
    groups = common_groups();
  }
  read_anchors(root, groups, scene);
  read_obstacles(root, scene);
  root.finish();
  scene.resolved_toml = root.to_toml_text();
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
