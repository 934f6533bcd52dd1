#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "record/frame_selector.hpp"
#include "record/frame_sink.hpp"
#include "scene/scene.hpp"
#include "store/checkpoint_file.hpp"

namespace fw::app {

/// What the user gives to `federwerk simulate`.
struct SimulateArguments {
  std::string scene, method, output, petsc, checkpoint, continued, from;
  std::vector<std::string> log_at, stop_at;
  double step = 0.0, relative_tolerance = 0.0, absolute_tolerance = 0.0, end_time = 0.0, every = 0.0;
  double velocity_tolerance = 0.0;  ///< absolute
  double maximum_step = std::numeric_limits<double>::infinity();
  bool has_step = false, has_relative = false, has_absolute = false, has_velocity_tolerance = false,
       xdmf = false, has_petsc = false;
  bool has_end_time = false, has_frames = false, has_every = false;
  std::int64_t frames = record::default_frames;
};

/// The program as a checkpoint names it.
std::string program_name();

/// What the user has given beside --continue has to be what the checkpoint was made with; the rest comes from it.
/// Throws InputError that names the option.
void take_from_checkpoint(const store::Checkpoint& from, SimulateArguments& arguments);

/// Throws InputError where --checkpoint and --every do not fit together.
void check_checkpoint_options(const SimulateArguments& arguments);

/// Where the run before started.
Vector first_state(const store::Checkpoint& from, const scene::Scene& scene);

/// The frames of the run before, into the sink of the one that continues it.
void repeat_frames(const store::Checkpoint& from, record::FrameSelector& frames, record::FrameSink& sink);

}  // namespace fw::app
