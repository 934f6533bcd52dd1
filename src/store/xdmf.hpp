#pragma once

#include <filesystem>

namespace fw::store {

/// Writes `<name>.xdmf` beside the trajectory `<name>.h5`: a collection of grids in time for ParaView and
/// VTK, with the springs as two-point lines (points if there are none), positions as geometry and velocities
/// as a vector attribute, all referring to the HDF5 file. Returns its path. Throws InputError, SystemError.
std::filesystem::path write_xdmf(const std::filesystem::path& h5_path);

}  // namespace fw::store
