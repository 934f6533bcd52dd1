#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include "app/process.hpp"
#include "app/result_text.hpp"

namespace fw::app::test {
namespace {

using store::test::ScratchDirectory;
using store::test::write_bytes;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Words = std::vector<std::string>;

const std::string chain = R"(title = "chain"
[world]
gravity = [0, 0, -9.81]
drag = 0.01
[particles]
position = [[0.1, 0.2, 0.3], [1, 0, 0], [1.5, 0.5, 0], [2.5, 0.4, 0.1]]
velocity = [[0, 0, 0], [0, 1, 0], [0, 0, 1], [0.1, 0, 0]]
mass = [1, 2, 3, 0.7]
fixed = [0]
[springs]
between = [[0, 1], [1, 2], [2, 3]]
stiffness = [100, 80, 60]
damping = 0.1
)";

/// Every dataset but seconds and every attribute but those that tell of program and time is the same, bit for
/// bit.
const std::string same_files = R"(
assert same(f, g) > 15
for name in ('title', 'spec', 'status', 'solver_status', 'kind'):
    assert f.attrs[name] == g.attrs[name], name
)";

class CheckpointCommand : public ::testing::Test {
 protected:
  void SetUp() override { write_bytes(scratch_ / "s.toml", chain); }

  std::string file(const std::string& name) const { return (scratch_ / name).string(); }
  ProcessResult simulate(const Words& arguments) const {
    Words all{"simulate"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return run(scratch_.path(), all);
  }
  void wait_for(const std::string& name) const {
    for (int k = 0; k < 3000 && !std::filesystem::exists(scratch_ / name); ++k) ::usleep(10'000);
    ASSERT_TRUE(std::filesystem::exists(scratch_ / name));
  }

  ScratchDirectory scratch_;
};

TEST_F(CheckpointCommand, OfAKilledRunGoesOnToTheSameFile) {
  const Words task{"s.toml",  "--method", "velocity_verlet", "--step", "1e-5",
                   "--t-end", "4",        "--frames",        "41"};
  Words whole = task, stopped = task;
  whole.insert(whole.end(), {"-o", "whole.h5"});
  ASSERT_EQ(simulate(whole).exit_code, 0);
  stopped.insert(stopped.end(), {"-o", "part.h5", "--checkpoint", "run.chk", "--every", "0.13"});
  Process process(scratch_.path(), [&] {
    Words all{"simulate"};
    all.insert(all.end(), stopped.begin(), stopped.end());
    return all;
  }());
  wait_for("run.chk");
  process.send(SIGKILL);
  EXPECT_EQ(process.wait().signal, SIGKILL);
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "part.h5"));
  const ProcessResult rest = simulate({"--continue", "run.chk", "-o", "rest.h5"});
  EXPECT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_THAT(rest.out, HasSubstr("rest.h5: 41 frames to t = 4 s, 400000 steps"));
  inspect(same_files, {file("whole.h5"), file("rest.h5")});
}

TEST_F(CheckpointCommand, OfAnInterruptedRunLosesNoStep) {
  Process process(scratch_.path(),
                  {"simulate", "s.toml", "--method", "adams_bashforth3", "--step", "1e-5", "--t-end", "1000",
                   "-o", "part.h5", "--checkpoint", "run.chk", "--every", "1000"});
  ::usleep(400'000);
  process.send(SIGINT);
  const ProcessResult stopped = process.wait();
  EXPECT_EQ(stopped.exit_code, 3);
  EXPECT_THAT(stopped.err, HasSubstr("interrupted by the user at t = "));
  EXPECT_THAT(stopped.err, HasSubstr("--continue run.chk goes on from the last checkpoint"));
  EXPECT_THAT(scratch_.names(), ElementsAre("part.h5", "run.chk", "s.toml"));
}

/// A run with checkpoints goes on from its last one, so that only the end is computed twice.
TEST_F(CheckpointCommand, GoesOnBitForBitWithOwnDenseOutputTolerancesAndHistories) {
  const std::vector<Words> tasks = {
      {"--method", "dormand_prince_54", "--rtol", "1e-7", "--atol", "1e-9"},
      {"--method", "bdf3", "--step", "0.01"},
      {"--method", "implicit_euler_linearised[tangent=psd_projection]", "--step", "0.03"},
      {"--method", "rodas4", "--rtol", "1e-5", "--atol", "1e-7"}};
  for (Words task : tasks) {
    task.insert(task.end(), {"s.toml", "--t-end", "2", "--frames", "31", "-o", "whole.h5", "--checkpoint",
                             "a.chk", "--every", "0.7"});
    const ProcessResult whole = simulate(task);
    ASSERT_EQ(whole.exit_code, 0) << whole.err;
    const ProcessResult rest =
        simulate({"--continue", "a.chk", "-o", "rest.h5", "--checkpoint", "b.chk", "--every", "0.2"});
    ASSERT_EQ(rest.exit_code, 0) << rest.err;
    inspect(same_files, {file("whole.h5"), file("rest.h5")});
    const ProcessResult again = simulate({"--continue", "b.chk", "-o", "again.h5"});
    ASSERT_EQ(again.exit_code, 0) << again.err;
    inspect(same_files, {file("whole.h5"), file("again.h5")});
  }
}

TEST_F(CheckpointCommand, RefusesWhatDoesNotBelongToTheCheckpoint) {
  ASSERT_EQ(simulate({"s.toml", "--method", "rk4", "--step", "0.01", "--t-end", "1", "-o", "a.h5",
                      "--checkpoint", "run.chk", "--every", "0.5"})
                .exit_code,
            0);
  const auto expect = [&](Words more, const std::string& message) {
    Words all{"--continue", "run.chk", "-o", "b.h5"};
    all.insert(all.end(), more.begin(), more.end());
    const ProcessResult result = simulate(all);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr(message));
    EXPECT_FALSE(std::filesystem::exists(scratch_ / "b.h5"));
  };
  expect({"--method", "verlet"}, "--method: found verlet, expected rk4 as in the checkpoint \"run.chk\"");
  expect({"--step", "0.02"}, "--step: found 0.02, expected 0.01 as in the checkpoint \"run.chk\"");
  expect({"--t-end", "2"}, "--t-end: found 2, expected 1 as in the checkpoint \"run.chk\"");
  expect({"--frames", "7"}, "--frames: found 7, expected none as in the checkpoint \"run.chk\"");
  expect({"--rtol", "1e-5"}, "found tolerances, expected --step 0.01 as in the checkpoint \"run.chk\"");
  std::string other = chain;
  write_bytes(scratch_ / "t.toml", other.replace(other.find("0.7]"), 3, "0.8"));
  expect({"t.toml"},
         "scene \"t.toml\" is not the scene of the checkpoint \"run.chk\" (\"s.toml\" at that time)");
  const ProcessResult same = simulate(
      {"s.toml", "--method", "rk4", "--step", "0.01", "--t-end", "1", "--continue", "run.chk", "-o", "b.h5"});
  EXPECT_EQ(same.exit_code, 0) << same.err;
}

TEST_F(CheckpointCommand, RefusesAFileThatIsDamagedForeignOrMissing) {
  ASSERT_EQ(simulate({"s.toml", "--method", "rk4", "--step", "0.01", "--t-end", "1", "-o", "a.h5",
                      "--checkpoint", "run.chk", "--every", "0.5"})
                .exit_code,
            0);
  const std::string good = store::test::read_bytes(scratch_ / "run.chk");
  const auto expect = [&](const std::string& content, const std::string& message) {
    write_bytes(scratch_ / "bad.chk", content);
    const ProcessResult result = simulate({"--continue", "bad.chk", "-o", "b.h5"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr(message));
  };
  for (const std::size_t place : {std::size_t{40}, good.size() / 2, good.size() - 100}) {
    std::string damaged = good;
    damaged[place] = static_cast<char>(damaged[place] ^ 1);
    expect(damaged, "checkpoint \"bad.chk\" is damaged: its content does not match its SHA-256");
  }
  expect(good.substr(0, good.size() - 5),
         "checkpoint \"bad.chk\" is truncated: it has no SHA-256 at its end");
  expect(chain, "\"bad.chk\" is no checkpoint of federwerk");
  expect("federwerk checkpoint 3\n" + good.substr(23), "found version \"3\" of the format, expected 2");
  EXPECT_THAT(simulate({"--continue", "none.chk", "-o", "b.h5"}).err, HasSubstr("cannot read \"none.chk\""));
  // Nothing is lost to a mistyped name.
  const ProcessResult result = simulate({"s.toml", "--method", "rk4", "--step", "0.01", "--t-end", "1", "-o",
                                         "b.h5", "--checkpoint", "s.toml", "--every", "0.5"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("--checkpoint would overwrite \"s.toml\", which is no checkpoint"));
}

TEST_F(CheckpointCommand, RefusesOptionsThatLackTheirOther) {
  const Words task{"s.toml", "--method", "rk4", "--step", "0.01", "--t-end", "1"};
  const auto expect = [&](Words more, const std::string& message) {
    Words all = task;
    all.insert(all.end(), more.begin(), more.end());
    const ProcessResult result = simulate(all);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr(message));
  };
  expect({"--every", "1"}, "found --every without --checkpoint, expected both");
  expect({"--checkpoint", "c"}, "found --checkpoint without --every, expected both");
  expect({"--checkpoint", "c", "--every", "0"}, "--every: found 0, expected a finite number > 0");
  EXPECT_THAT(scratch_.names(), ElementsAre("s.toml"));
}

TEST_F(CheckpointCommand, OfAForeignMethodIsRefusedAtOnce) {
  const ProcessResult result =
      simulate({"s.toml", "--method", "sundials:cvode_bdf", "--rtol", "1e-6", "--atol", "1e-8", "--t-end",
                "1", "-o", "a.h5", "--checkpoint", "c", "--every", "0.1"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err,
              HasSubstr("method \"sundials:cvode_bdf\" cannot be saved: the library does not give out "
                        "its memory"));
  EXPECT_THAT(scratch_.names(), ElementsAre("s.toml"));
}

}  // namespace
}  // namespace fw::app::test
