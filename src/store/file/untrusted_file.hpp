#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace fw::store {

/// Why HDF5 cannot be let loose on the content of a file that has no seal; empty if it can.
///
/// A process of its own with bounded memory and time opens the file and reads every object, attribute and
/// dataset of it, so that a crash of the library, an endless loop or sizes that are believed from the file
/// end there. Links out of the file are refused. The caller holds a LibraryLock.
std::string fault_of_untrusted(const std::filesystem::path& path, std::uint64_t file_size);

}  // namespace fw::store
