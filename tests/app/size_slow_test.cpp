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

TEST(Size, TenMillionStepsOfASmallSystemTakeTheMemoryOfAThousand) {
  const ScratchDirectory scratch;
  write_bytes(scratch / "s.toml",
              "[particles]\nposition = [[0,0,0], [1.1,0,0]]\nmass = 1\nfixed = [0]\n"
              "[springs]\nbetween = [[0,1]]\nstiffness = 1\nrest_length = 1\n");
  for (const std::string method : {"verlet", "velocity_verlet", "rk4"}) {
    const auto steps = [&](const std::string& end) {
      return run(scratch.path(),
                 {"simulate", "s.toml", "--method", method, "--step", "1e-3", "--t-end", end, "-o", "a.h5"});
    };
    const ProcessResult few = steps("1"), many = steps("10000");
    ASSERT_EQ(few.exit_code, 0) << few.err;
    ASSERT_EQ(many.exit_code, 0) << many.err;
    record(method + "_1e3_steps", few);
    record(method + "_1e7_steps", many);
    EXPECT_LT(many.peak_memory, few.peak_memory + 4 * mebibyte);
    inspect(
        "assert f['counters/accepted_steps'][()] == 10**7 and len(f['trajectory/time']) == 101\n"
        "assert f['trajectory/time'][-1] == 10000\n",
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
  const auto simulate = [&](const std::string& end) {
    return run(scratch.path(), {"simulate", "s.toml", "--method", "symplectic_euler", "--step", "1e-4",
                                "--t-end", end, "--frames", "2", "-o", "a.h5"});
  };
  const ProcessResult one = simulate("1e-4"), hundred = simulate("1e-2");
  ASSERT_EQ(one.exit_code, 0) << one.err;
  ASSERT_EQ(hundred.exit_code, 0) << hundred.err;
  record("cloth_1_step", one);
  record("cloth_100_steps", hundred);
  EXPECT_LT(hundred.peak_memory, 4 * 1024 * mebibyte);
  inspect(R"(
springs = f['system/springs'].shape[0]
assert abs(springs - 6e6) < 0.01 * 6e6, springs
assert f['counters/accepted_steps'][()] == 100 and f.attrs['status'] == 'complete'
x = f['trajectory/position'][-1]
assert x.shape == (10**6, 3) and np.isfinite(x).all() and x[:, 2].min() < -1e-5
)",
          {(scratch / "a.h5").string()});
}

}  // namespace
}  // namespace fw::app::test
