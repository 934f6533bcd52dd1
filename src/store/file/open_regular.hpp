#pragma once

#include <filesystem>
#include <memory>

#include "store/hdf5/file_driver.hpp"

namespace fw::store {

/// A file opened for reading. Throws InputError that names the path: not there, no permission, no regular
/// file.
std::shared_ptr<DriverFile> open_regular(const std::filesystem::path& path);

}  // namespace fw::store
