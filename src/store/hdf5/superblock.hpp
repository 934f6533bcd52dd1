#pragma once

#include <cstdint>
#include <optional>

#include "store/hdf5/file_driver.hpp"

namespace fw::store {

/// What the first bytes of a file say, read without the library.
struct Superblock {
  /// Bytes of HDF5 content; nothing where the version or the width of addresses is unknown.
  std::optional<std::uint64_t> end_of_content;
};

/// Nothing if the file does not begin with HDF5's signature [HDF5 File Format Specification 3.0, II.A].
std::optional<Superblock> read_superblock(const DriverFile& file);

}  // namespace fw::store
