#include "app/continued_run.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>

#include "app/input_kind.hpp"
#include "core/error.hpp"
#include "system/provenance.hpp"

namespace fw::app {

std::string program_name() {
  const Provenance here = provenance();
  return fmt::format("federwerk {} ({}{}, {})", version(), here.git_commit.substr(0, 12),
                     here.git_dirty ? ", changed" : "", here.compiler);
}

void take_from_checkpoint(const store::Checkpoint& from, SimulateArguments& arguments) {
  const auto compare = [&](bool is_given, const char* what, const auto& found, const auto& expected) {
    if (!is_given || found == expected) return;
    throw InputError(fmt::format("{}: found {}, expected {} as in the checkpoint \"{}\"", what, found,
                                 expected, arguments.continued));
  };
  if (!arguments.scene.empty() && read_scene_for(arguments.scene, "simulate").resolved_toml != from.scene) {
    throw InputError(
        fmt::format("scene \"{}\" is not the scene of the checkpoint \"{}\" (\"{}\" at that time)",
                    arguments.scene, arguments.continued, from.scene_name));
  }
  compare(!arguments.method.empty(), "--method", arguments.method, from.method);
  compare(arguments.has_petsc, "--petsc", arguments.petsc, from.petsc);
  compare(arguments.has_end_time, "--t-end", arguments.end_time, from.end_time);
  if (arguments.has_frames && from.frames == 0) {
    throw InputError(fmt::format("--frames: found {}, expected none as in the checkpoint \"{}\"",
                                 arguments.frames, arguments.continued));
  }
  compare(arguments.has_frames, "--frames", arguments.frames, static_cast<std::int64_t>(from.frames));
  if (const auto* fixed = std::get_if<FixedStep>(&from.control)) {
    if (arguments.has_relative || arguments.has_absolute || arguments.has_velocity_tolerance) {
      throw InputError(fmt::format("found tolerances, expected --step {} as in the checkpoint \"{}\"",
                                   fixed->step, arguments.continued));
    }
    compare(arguments.has_step, "--step", arguments.step, fixed->step);
    arguments.step = fixed->step;
    arguments.has_step = true;
  } else {
    const auto& adaptive = std::get<AdaptiveStep>(from.control);
    if (arguments.has_step) {
      throw InputError(
          fmt::format("found --step, expected --rtol {} and --atol {} as in the checkpoint \"{}\"",
                      adaptive.relative_tolerance, adaptive.absolute_tolerance, arguments.continued));
    }
    compare(arguments.has_relative, "--rtol", arguments.relative_tolerance, adaptive.relative_tolerance);
    compare(arguments.has_absolute, "--atol", arguments.absolute_tolerance, adaptive.absolute_tolerance);
    compare(arguments.has_velocity_tolerance, "--atol-velocity", arguments.velocity_tolerance,
            adaptive.absolute_velocity_tolerance);
    compare(std::isfinite(arguments.maximum_step), "--maximum-step", arguments.maximum_step,
            adaptive.maximum_step);
    arguments.maximum_step = adaptive.maximum_step;
    arguments.relative_tolerance = adaptive.relative_tolerance;
    arguments.absolute_tolerance = adaptive.absolute_tolerance;
    arguments.velocity_tolerance = adaptive.absolute_velocity_tolerance;
    arguments.has_relative = arguments.has_absolute = true;
    arguments.has_velocity_tolerance = adaptive.absolute_velocity_tolerance > 0.0;
  }
  arguments.scene = from.scene_name;
  arguments.method = from.method;
  arguments.petsc = from.petsc;
  arguments.has_petsc = !from.petsc.empty();
  arguments.end_time = from.end_time;
  arguments.frames = static_cast<std::int64_t>(from.frames);
  arguments.has_frames = from.frames != 0;  // 0: the default
  if (arguments.output.empty()) arguments.output = from.output;
  if (const std::string here = program_name(); here != from.program) {
    fmt::print(
        stderr,
        "federwerk: note: the checkpoint was written by {}, this is {}; the end may differ in its last "
        "digits\n",
        from.program, here);
  }
}

void check_checkpoint_options(const SimulateArguments& arguments) {
  if (arguments.checkpoint.empty() != !arguments.has_every) {
    throw InputError(arguments.has_every ? "found --every without --checkpoint, expected both"
                                         : "found --checkpoint without --every, expected both");
  }
  if (arguments.checkpoint.empty()) return;
  if (!std::isfinite(arguments.every) || arguments.every <= 0.0) {
    throw InputError(fmt::format("--every: found {}, expected a finite number > 0", arguments.every));
  }
  store::check_checkpoint_target(arguments.checkpoint);
}

Vector first_state(const store::Checkpoint& from, const scene::Scene& scene) {
  if (from.frame_times.empty()) return initial_state(scene);
  const std::size_t size = from.frame_states.size() / from.frame_times.size();
  return ConstVectorMap(from.frame_states.data(), static_cast<Index>(size));
}

void repeat_frames(const store::Checkpoint& from, record::FrameSelector& frames, record::FrameSink& sink) {
  const std::size_t count = from.frame_times.size();
  const std::size_t size = count == 0 ? 0 : from.frame_states.size() / count;
  for (std::size_t k = 0; k < count; ++k) {
    sink.frame(from.frame_times[k],
               ConstVectorMap(from.frame_states.data() + k * size, static_cast<Index>(size)));
  }
  frames.resume(count);
}

}  // namespace fw::app
