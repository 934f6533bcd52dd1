#pragma once

#include <filesystem>
#include <string>

#include "store/file_header.hpp"
#include "store/hdf5/attribute.hpp"
#include "study/result.hpp"

namespace fw::store {

/// A study with all root attributes of its file.
struct StudyFile {
  Attributes attributes;
  study::StudyResult result;
};

/// Writes a result file with /cases and /summary, sealed by its SHA-256, whole or not at all. Kind, title,
/// spec and seed are those of the result. Throws SystemError (disk full), InputError (a result that
/// contradicts itself).
void write_study(const std::filesystem::path& path, const std::string& command_line,
                 const study::StudyResult& result);

/// Reads it back. Throws InputError that names the file.
StudyFile read_study(const std::filesystem::path& path);

}  // namespace fw::store
