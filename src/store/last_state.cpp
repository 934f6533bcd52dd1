#include "store/last_state.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/error.hpp"
#include "store/hdf5/dataset.hpp"
#include "store/input_file.hpp"

namespace fw::store {

LastState read_last_state(const std::filesystem::path& path) {
  const LibraryLock lock;
  const InputFile file(path);
  if (!has_link(file.id(), "trajectory")) {
    throw InputError(
        fmt::format("\"{}\" holds no trajectory (its kind is \"{}\"), expected a result of \"federwerk "
                    "simulate\" or \"federwerk equilibrium\"",
                    path.string(), file.kind()));
  }
  LastState last;
  try {
    const Handle trajectory = open_group(file.id(), "trajectory");
    const Shape shape = dataset_shape(trajectory, "position");
    if (shape.size() != 3 || shape[2] != 3 || dataset_shape(trajectory, "velocity") != shape) {
      throw LibraryError("positions and velocities are not of one shape (F, n, 3)");
    }
    if (shape[0] == 0) throw LibraryError("it holds no frame");
    const record::Column time = read_dataset(trajectory, "time");
    const auto* times = std::get_if<std::vector<double>>(&time.values);
    if (times == nullptr || times->size() != shape[0])
      throw LibraryError("the times are not those of the frames");
    last.time = times->back();
    const std::vector<double> position = read_row(trajectory, "position", shape[0] - 1);
    const std::vector<double> velocity = read_row(trajectory, "velocity", shape[0] - 1);
    const auto size = static_cast<Index>(position.size());
    last.state.resize(2 * size);
    last.state << ConstVectorMap(position.data(), size), ConstVectorMap(velocity.data(), size);
  } catch (const LibraryError& error) {
    throw InputError(fmt::format("\"{}\": {}", path.string(), error.what()));
  }
  if (!last.state.allFinite()) {
    throw InputError(
        fmt::format("\"{}\": the last frame (t = {:.6g} s) is not finite", path.string(), last.time));
  }
  return last;
}

}  // namespace fw::store
