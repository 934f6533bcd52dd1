#include "core/run_clock.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace fw {
namespace {

TEST(RunClock, LeavesOutTheStartOfLibraries) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  const RunClock clock;
  {
    const LibraryStart start;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  const double seconds = clock.seconds();
  const double all = std::chrono::duration<double>(Clock::now() - begin).count();
  EXPECT_GE(seconds, 0.0);
  EXPECT_LE(seconds, all - 0.02);
  // A clock that starts later knows nothing of it.
  const RunClock later;
  EXPECT_GE(later.seconds(), 0.0);
}

}  // namespace
}  // namespace fw
