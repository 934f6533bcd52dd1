#pragma once

#include <string>

namespace fw {

/// Where a number comes from: written into every result file.
struct Provenance {
  std::string git_commit;      ///< 40 hexadecimal digits, or "unknown" outside a checkout
  bool git_dirty = false;      ///< the work tree differed from that commit when the program was built
  std::string compiler;        ///< for example "GNU 12.2.0"
  std::string compiler_flags;  ///< the options of this build type
  std::string cpu;             ///< the processor's model name, read at run time
  std::string libraries;       ///< "name=version" separated by spaces
};

/// The provenance of this executable on this machine.
Provenance provenance();

/// "2026-01-31T12:34:56Z", the current time in UTC as ISO 8601.
std::string timestamp_utc();

/// The version of federwerk, "major.minor.patch".
std::string version();

}  // namespace fw
