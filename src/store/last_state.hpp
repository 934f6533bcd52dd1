#pragma once

#include <filesystem>

#include "core/types.hpp"

namespace fw::store {

/// The last frame of a trajectory.
struct LastState {
  double time = 0.0;  ///< [s]
  Vector state;       ///< y = (x, v), 6n entries
};

/// Reads the last frame of a result file of kind "trajectory". Throws InputError that names the file: as
/// `InputFile`, and where it holds no frame, or one that is not finite.
LastState read_last_state(const std::filesystem::path& path);

}  // namespace fw::store
