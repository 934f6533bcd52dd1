#pragma once

#include <chrono>

namespace fw {

/// Its life is the start of a library, which a process does once: no part of the run that happens to be the
/// first to need it. Not nested.
class LibraryStart {
 public:
  LibraryStart() = default;
  ~LibraryStart();
  LibraryStart(const LibraryStart&) = delete;
  LibraryStart& operator=(const LibraryStart&) = delete;

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// The wall time since it was made [s], without the starts of libraries in this thread meanwhile.
class RunClock {
 public:
  RunClock();
  double seconds() const;

 private:
  std::chrono::steady_clock::time_point start_;
  double library_starts_;  ///< of this thread before [s]
};

}  // namespace fw
