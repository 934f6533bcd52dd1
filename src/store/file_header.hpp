#pragma once

#include <cstdint>
#include <string>

#include "store/hdf5/attribute.hpp"

namespace fw::store {

inline constexpr const char* format_name = "federwerk";
inline constexpr std::int64_t format_version = 1;

/// What the caller knows about a result; the rest of the root attributes is the provenance of the program.
struct FileHeader {
  std::string kind;  ///< "trajectory", "convergence", …
  std::string title;
  std::string command_line;  ///< as the user typed it
  std::string spec;          ///< the resolved input as TOML text
  std::int64_t seed = 0;     ///< of all random numbers
  bool quick = false;        ///< shrunk by its own [quick] section
};

/// The root attributes of docs/results_schema.md but `status`. Throws LibraryError.
void write_header(hid_t file, const FileHeader& header);

/// "complete" or "incomplete".
void write_status(hid_t file, bool complete);

}  // namespace fw::store
