#pragma once

#include "store/hdf5/file_driver.hpp"

namespace fw::store {

/// What the end of a file says about its content.
enum class SealState {
  absent,  ///< no seal: a file that was cut, that another program has changed since, or not ours
  intact,  ///< the SHA-256 of the content is the one in the seal
  broken,  ///< the content has changed
};

/// Bytes of a seal: "federwerk sha256 <64 hexadecimal digits>\n".
inline constexpr std::size_t seal_size = 17 + 64 + 1;

/// Appends "federwerk sha256 <64 hexadecimal digits>\n" to the content of the file. Errors are left in
/// `file.error_number()`.
void append_seal(DriverFile& file);

/// Compares the content with the seal at its end. Throws SystemError if the file cannot be read.
SealState check_seal(const DriverFile& file);

}  // namespace fw::store
