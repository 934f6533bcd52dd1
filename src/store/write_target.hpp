#pragma once

#include <filesystem>

namespace fw::store {

/// Makes the directory that `path` is in, with those above it, unless it is there. Throws InputError that names it,
/// SystemError on a full disk.
void make_directory_of(const std::filesystem::path& path);

/// To be called before a long computation whose result goes to `path`: throws InputError that names the path
/// if its directory is missing or cannot be written, if it is a directory, a device or protected against
/// writing, or if something is there that is no whole federwerk result and would be lost. Throws SystemError
/// on a full disk. Leaves nothing behind.
void check_writable_target(const std::filesystem::path& path);

/// The same for a text file that may always be replaced if it exists (XDMF); only its place is checked.
void check_writable_place(const std::filesystem::path& path);

}  // namespace fw::store
