#include "core/run_clock.hpp"

namespace fw {

namespace {

thread_local double library_starts = 0.0;  // [s]

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

LibraryStart::~LibraryStart() {
  library_starts += seconds_since(start_);
}

RunClock::RunClock() : start_(std::chrono::steady_clock::now()), library_starts_(library_starts) {}

double RunClock::seconds() const {
  return seconds_since(start_) - (library_starts - library_starts_);
}

}  // namespace fw
