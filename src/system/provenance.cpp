#include "system/provenance.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <fstream>

#include "provenance_build.hpp"

namespace fw {

namespace {

std::string cpu_model() {
  std::ifstream cpuinfo("/proc/cpuinfo");
  for (std::string line; std::getline(cpuinfo, line);) {
    if (line.rfind("model name", 0) == 0) {
      const auto colon = line.find(": ");
      if (colon != std::string::npos) return line.substr(colon + 2);
    }
  }
  return "unknown";
}

}  // namespace

Provenance provenance() {
  return {.git_commit = build::git_commit,
          .git_dirty = build::git_dirty,
          .compiler = build::compiler,
          .compiler_flags = build::compiler_flags,
          .cpu = cpu_model(),
          .libraries = build::libraries};
}

std::string timestamp_utc() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

std::string version() {
  return build::version;
}

}  // namespace fw
