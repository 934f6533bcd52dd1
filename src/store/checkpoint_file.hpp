#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "ode/step_control.hpp"

namespace fw::store {

/// A simulation on its way: all that "federwerk simulate --continue" needs to go on with it as if it had
/// never stopped. Its numbers are those of this machine's memory, bit for bit.
struct Checkpoint {
  std::string program{};     ///< version and commit that wrote it
  std::string scene_name{};  ///< the scene file as it was called
  std::string scene{};       ///< the resolved scene as TOML text
  std::string method{};      ///< the call, for example "rkc2[stages=5]"
  std::string petsc{};       ///< options of --petsc
  std::string output{};      ///< the result file
  StepControl control{};
  double end_time = 0.0;               ///< [s]
  std::uint64_t frames = 0;            ///< wanted, from start to end
  double time = 0.0;                   ///< [s] at the checkpoint
  std::vector<double> frame_times{};   ///< of the frames before [s]
  std::vector<double> frame_states{};  ///< their states (x, v), one after the other
  std::string run{};                   ///< the state of the run, `SolveOptions::resume`
};

/// Writes a checkpoint as a whole or not at all: temporary file, SHA-256 of its content at its end, rename.
/// The one before stays until then. Throws SystemError.
void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint);

/// Throws InputError that names the file: not there, no checkpoint, of another version of the format or
/// another byte order, truncated, damaged.
Checkpoint read_checkpoint(const std::filesystem::path& path);

/// To be called before a run with checkpoints: throws InputError where the place cannot be written, or
/// something is there that is no checkpoint and would be lost.
void check_checkpoint_target(const std::filesystem::path& path);

}  // namespace fw::store
