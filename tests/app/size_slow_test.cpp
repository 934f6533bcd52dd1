#include <gtest/gtest.h>

#include "app/process.hpp"
#include "app/result_text.hpp"

namespace fw::app::test {
namespace {

using store::test::ScratchDirectory;
using store::test::write_bytes;

constexpr long mebibyte = 1024;  ///< in KiB

void record(const std::string& name, const ProcessResult& result) {
  ::testing::Test::RecordProperty(name + "_seconds", std::to_string(result.seconds));
  ::testing::Test::RecordProperty(name + "_peak_mebibytes", std::to_string(result.peak_memory / mebibyte));
  std::printf("%s: %.1f s, peak %ld MiB\n", name.c_str(), result.seconds, result.peak_memory / mebibyte);
}

// Eight bytes that are kept per step are 8 MB in a million steps.
TEST(Size, AMillionAndTenMillionStepsOfASmallSystemTakeTheMemoryOfAThousand) {
  const ScratchDirectory scratch;
  write_bytes(scratch / "s.toml",
              "[particles]\nposition = [[0,0,0], [1.1,0,0]]\nmass = 1\nfixed = [0]\n"
              "[springs]\nbetween = [[0,1]]\nstiffness = 1\nrest_length = 1\n");
  for (const auto& [method, count] : {std::pair<std::string, long>{"verlet", 10'000'000},
                                      {"velocity_verlet", 1'000'000},
                                      {"rk4", 1'000'000}}) {
    const std::string end_time = std::to_string(count / 1000), number = std::to_string(count);
    const auto steps = [&](const std::string& end) {
      return run(scratch.path(),
                 {"simulate", "s.toml", "--method", method, "--step", "1e-3", "--t-end", end, "-o", "a.h5"});
    };
    const ProcessResult few = steps("1"), many = steps(end_time);
    ASSERT_EQ(few.exit_code, 0) << few.err;
    ASSERT_EQ(many.exit_code, 0) << many.err;
    record(method + "_1e3_steps", few);
    record(method + "_" + number + "_steps", many);
    EXPECT_LT(many.peak_memory, few.peak_memory + 4 * mebibyte);
    inspect("assert f['counters/accepted_steps'][()] == " + number +
                " and len(f['trajectory/time']) == 101\nassert f['trajectory/time'][-1] == " + end_time +
                "\n",
            {(scratch / "a.h5").string()});
  }
}

TEST(Size, AMillionFramesOfASmallSystemTakeTheMemoryOfAThousand) {
  const ScratchDirectory scratch;
  write_bytes(scratch / "s.toml", "[particles]\nposition = [[0,0,0]]\nvelocity = [[1,0,0]]\nmass = 1\n");
  const auto frames = [&](const std::string& number) {
    return run(scratch.path(), {"simulate", "s.toml", "--method", "rk4", "--step", "1e-3", "--t-end", "1000",
                                "--frames", number, "-o", "a.h5"});
  };
  const ProcessResult few = frames("1001"), many = frames("1000001");
  ASSERT_EQ(few.exit_code, 0) << few.err;
  ASSERT_EQ(many.exit_code, 0) << many.err;
  record("1e3_frames", few);
  record("1e6_frames", many);
  EXPECT_LT(many.peak_memory, few.peak_memory + 32 * mebibyte) << "the frames themselves are 180 MB";
  inspect("assert len(f['trajectory/time']) == 1000001\n", {(scratch / "a.h5").string()});
}

TEST(Size, AClothOfAMillionPointsIsSimulatedInFourGibibytes) {
  const ScratchDirectory scratch;
  write_bytes(scratch / "s.toml",
              "[world]\ngravity = [0, 0, -9.81]\n[generate]\nkind = 'cloth'\ncounts = [1000, 1000]\n"
              "spacing = 0.01\nmass = 1e-3\nstiffness = 100\ndamping = 1e-3\npinned = 'top_edge'\n");
  const ProcessResult steps =
      run(scratch.path(), {"simulate", "s.toml", "--method", "symplectic_euler", "--step", "1e-4", "--t-end",
                           "2e-3", "--frames", "2", "-o", "a.h5"});
  ASSERT_EQ(steps.exit_code, 0) << steps.err;
  record("cloth_20_steps", steps);
  EXPECT_LT(steps.peak_memory, 4 * 1024 * mebibyte);
  inspect(R"(
springs = f['system/springs'].shape[0]
assert abs(springs - 6e6) < 0.01 * 6e6, springs
assert f['counters/accepted_steps'][()] == 20 and f.attrs['status'] == 'complete'
x = f['trajectory/position'][-1]
assert x.shape == (10**6, 3) and np.isfinite(x).all() and x[:, 2].min() < -1e-5
)",
          {(scratch / "a.h5").string()});
}

}  // namespace
}  // namespace fw::app::test
