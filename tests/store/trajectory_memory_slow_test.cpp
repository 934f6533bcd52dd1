#include <gtest/gtest.h>
#include <sys/resource.h>

#include "samples.hpp"
#include "scratch_directory.hpp"
#include "store/trajectory_writer.hpp"

// Not for the sanitizer run, whose own memory would be measured.

namespace fw::store::test {
namespace {

/// Peak of resident memory of this process [bytes].
std::size_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

TEST(TrajectoryWriter, StreamsTenThousandFramesInBoundedMemory) {
  const ScratchDirectory scratch;
  const int n = 150, frames = 10000;
  const int status = in_child([&] {
    TrajectoryWriter writer(scratch / "a.h5", header(), chain(n), known_quantities, frames);
    const Vector state = known_state(n, 1);
    writer.frame(0.0, state);
    const std::size_t before = peak_memory();
    for (int f = 1; f < frames; ++f) writer.frame(f, state);
    writer.finish({}, {});
    const std::size_t growth = peak_memory() - before;
    std::fprintf(stderr, "peak memory grew by %zu KiB\n", growth / 1024);
    return before > 0 && growth < 12U * 1024 * 1024 ? 0 : 1;
  });
  EXPECT_EQ(status, 0);
  EXPECT_GT(std::filesystem::file_size(scratch / "a.h5"), 70U * 1000 * 1000);
}

TEST(TrajectoryWriter, AFrameOfAMillionParticlesNeedsNoSecondCopy) {
  const ScratchDirectory scratch;
  const int n = 1000000;
  const int status = in_child([&] {
    mechanics::MassSpringModel model;
    model.mass.assign(n, 1.0);
    const Vector state = known_state(n, 1);  // 48 MB
    const std::size_t before = peak_memory();
    TrajectoryWriter writer(scratch / "a.h5", header(), model, known_quantities, 2);
    writer.frame(0.0, state);
    writer.finish({}, {});
    const std::size_t growth = peak_memory() - before;
    std::fprintf(stderr, "peak memory grew by %zu KiB\n", growth / 1024);
    return before > 48U * 1000 * 1000 && growth < 16U * 1024 * 1024 ? 0 : 1;
  });
  EXPECT_EQ(status, 0);
}

}  // namespace
}  // namespace fw::store::test
