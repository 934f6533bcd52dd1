#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/types.hpp"
#include "mechanics/mass_spring_model.hpp"
#include "ode/ivp.hpp"
#include "text/checked_table.hpp"

namespace fw::scene {

/// A mass-spring system and its state at the start, as described by a scene file.
struct Scene {
  std::string title;
  mechanics::MassSpringModel model;
  Vector position;  ///< 3n, xyz after xyz [m]
  Vector velocity;  ///< 3n, zero for fixed particles [m/s]
  /// The run starts at the static equilibrium that is found from `position`.
  bool starts_at_equilibrium = false;
  std::string resolved_toml;          ///< the input as TOML text with every default filled in
  std::vector<std::string> warnings;  ///< what is legal but has no effect, one sentence each
};

/// Reads a scene file (TOML; docs/scene_format.md). InputError with file, line, key and index for everything
/// that is unknown, missing, of the wrong type, size or sign; nothing is ignored silently.
Scene read_scene(const std::filesystem::path& path);

/// The same for a text; `name` stands for the file in messages. The `resolved_toml` of a scene gives that
/// scene again, bit for bit.
Scene parse_scene(std::string_view text, std::string name);

/// The same for a document that has been parsed, with numbers put into it, say.
Scene read_scene(const CheckedTable& document);

/// y = (x, v), 6n entries.
Vector initial_state(const Scene& scene);

/// The motion of the scene from t = 0 to `end_time` [s]. InputError if the end time is not positive and
/// finite.
Ivp make_ivp(const Scene& scene, double end_time);

}  // namespace fw::scene
