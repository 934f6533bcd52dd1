#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <signal.h>
#include <unistd.h>
#include <algorithm>
#include <filesystem>
#include <map>

#include "app/result_text.hpp"
#include "app/simulate_fixture.hpp"
#include "catalog/methods.hpp"

namespace fw::app::test {
namespace {

using store::test::read_bytes;
using store::test::ScratchDirectory;
using store::test::write_bytes;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(Simulate, StoresTheFramesNearestToAnEqualSpacing) {
  const ProcessResult result =
      simulate("a.h5", {"--method", "rk4", "--step", "0.01", "--t-end", "1", "--frames", "8"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
  EXPECT_THAT(result.out, HasSubstr("a.h5: 8 frames, unevenly spaced, to t = 1 s"));
  EXPECT_THAT(scratch_.names(), ElementsAre("a.h5", "s.toml"));
  inspect(R"(
t = f['trajectory/time'][()]
assert len(t) == 8 and t[0] == 0 and t[-1] == 1
k = np.rint(np.linspace(0, 1, 8) / 0.01)
assert np.array_equal(t[:-1], k[:-1] * 0.01), t
assert np.array_equal(f['trajectory/position'][0], [[0.1, 0.2, 0.3], [1, 0, 0], [1.5, 0.5, 0]])
assert np.array_equal(f['trajectory/velocity'][0], [[0, 0, 0], [0, 1, 0], [0, 0, 1]])
assert f.attrs['status'] == 'complete' and f.attrs['solver_status'] == 'success'
assert f.attrs['frame_origin'] == 'ends of steps' and f.attrs['frame_spacing'] == 'uneven'
assert f.attrs['title'] == 'pendulum' and 'simulate s.toml' in f.attrs['command_line']
assert f['counters/accepted_steps'][()] == 100 and f['counters/rhs_evaluations'][()] == 400
)",
          {file("a.h5")});
}

TEST_F(Simulate, SaysThatAnExplosionBelowEveryBoundIsNoSuccess) {
  write_bytes(scratch_ / "s.toml",
              "[world]\ngravity = [0, 0, -9.81]\n[particles]\nposition = [[0, 0, 0], [1, 0, 0]]\nmass = "
              "1\nfixed = [0]\n"
              "[springs]\nbetween = [[0, 1]]\nstiffness = 1e4\n");
  const ProcessResult result =
      simulate("a.h5", {"--method", "velocity_verlet", "--step", "0.05", "--t-end", "1"});
  EXPECT_EQ(result.exit_code, 3) << result.err;
  EXPECT_THAT(result.err, AllOf(HasSubstr("blow_up: the energy grows by the factor"), HasSubstr("a.h5")));
  EXPECT_TRUE(std::filesystem::exists(scratch_ / "a.h5"));
  const ProcessResult stable =
      simulate("b.h5", {"--method", "velocity_verlet", "--step", "0.005", "--t-end", "1"});
  EXPECT_EQ(stable.exit_code, 0) << stable.err;
}

TEST_F(Simulate, ASystemAtRestOrBetweenTwoFramesIsNoExplosion) {
  // Rest lengths that are off by the last digit: rounding alone moves it.
  write_bytes(scratch_ / "s.toml",
              "[particles]\nposition = [[0, 0, 0], [0.1, 0.2, 0.2]]\nmass = 1\nfixed = [0]\n"
              "[springs]\nbetween = [[0, 1]]\nstiffness = 100\nrest_length = 0.3\n");
  for (const char* step : {"1e-3", "1e-5", "0.1"}) {
    const ProcessResult rest =
        simulate("a.h5", {"--method", "velocity_verlet", "--step", step, "--t-end", "0.5"});
    EXPECT_EQ(rest.exit_code, 0) << step << rest.err;
  }
  // A swing from rest to rest, of which the file has both ends only; and one step from rest.
  write_bytes(scratch_ / "s.toml",
              "[world]\ngravity = [0, 0, -9.81]\n[particles]\nposition = [[0, 0, 0], [1, 0, 0]]\nmass = "
              "1\nfixed = [0]\n"
              "[springs]\nbetween = [[0, 1]]\nstiffness = 1e4\n");
  const ProcessResult swing =
      simulate("b.h5", {"--method", "rk4", "--step", "1e-3", "--t-end", "2.37", "--frames", "2"});
  EXPECT_EQ(swing.exit_code, 0) << swing.err;
  const ProcessResult one =
      simulate("c.h5", {"--method", "explicit_euler", "--step", "1e-3", "--t-end", "1e-3"});
  EXPECT_EQ(one.exit_code, 0) << one.err;
  // An explosion that the frames do not show is seen.
  const ProcessResult hidden =
      simulate("d.h5", {"--method", "velocity_verlet", "--step", "0.05", "--t-end", "1", "--frames", "2"});
  EXPECT_EQ(hidden.exit_code, 3) << hidden.err;
}

TEST_F(Simulate, Stores101FramesUnlessAskedOtherwise) {
  EXPECT_EQ(simulate("a.h5", {"--method", "rk4", "--step", "0.001", "--t-end", "1"}).exit_code, 0);
  inspect("assert f['trajectory/time'].shape == (101,)\n", {file("a.h5")});
}

TEST_F(Simulate, StoresEveryStateOnceWhereThereAreFewerStepsThanFrames) {
  EXPECT_EQ(simulate("a.h5", {"--method", "rk4", "--step", "0.25", "--t-end", "1"}).exit_code, 0);
  inspect("assert list(f['trajectory/time']) == [0, .25, .5, .75, 1]\n", {file("a.h5")});
}

TEST_F(Simulate, TellsOfAShorterLastStepAndTakesIt) {
  const ProcessResult result = simulate("a.h5", {"--method", "rk4", "--step", "0.3", "--t-end", "1"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("the last step is 0.1 s"));
  inspect(
      "t = f['trajectory/time'][()]\nassert np.allclose(t, [0, .3, .6, .9, 1], atol=1e-15) and t[-1] == 1\n",
      {file("a.h5")});
}

TEST_F(Simulate, TakesASingleStepShorterThanAsked) {
  const ProcessResult result = simulate("a.h5", {"--method", "rk4", "--step", "3", "--t-end", "0.01"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("the last step is 0.01 s"));
  ASSERT_EQ(simulate("b.h5", {"--method", "rk4", "--step", "0.01", "--t-end", "0.01"}).exit_code, 0);
  inspect("assert np.array_equal(f['trajectory/position'], g['trajectory/position'])\n",
          {file("a.h5"), file("b.h5")});
}

TEST_F(Simulate, SpacesFramesEvenlyWhereNoNumberIsAskedFor) {
  const ProcessResult result = simulate("a.h5", {"--method", "rk4", "--step", "0.004", "--t-end", "1"});
  EXPECT_THAT(result.out, HasSubstr("a.h5: 126 frames to t = 1 s"));
  inspect(R"(
t = f['trajectory/time'][()]
assert np.array_equal(t[:-1], np.arange(0, 250, 2) * 0.004) and t[-1] == 1, t
assert f.attrs['frame_origin'] == 'ends of steps' and f.attrs['frame_spacing'] == 'even'
)",
          {file("a.h5")});
  EXPECT_THAT(run(scratch_.path(), {"show", "a.h5"}).out, HasSubstr("frames    ends of steps; spacing even"));
}

TEST_F(Simulate, InterpolatesEquallySpacedFramesOfAnAdaptiveMethod) {
  const Words adaptive = {"--method", "sundials:cvode_bdf", "--rtol", "1e-9", "--atol", "1e-12", "--t-end",
                          "1"};
  Words many = adaptive;
  many.insert(many.end(), {"--frames", "41"});
  ASSERT_EQ(simulate("a.h5", many).exit_code, 0);
  ASSERT_EQ(
      simulate("b.h5", {"--method", "rk4", "--step", "0.001", "--t-end", "1", "--frames", "41"}).exit_code,
      0);
  inspect(R"(
t = f['trajectory/time'][()]
assert len(t) == 41 and t[0] == 0 and t[-1] == 1
assert np.allclose(t, np.linspace(0, 1, 41), rtol=0, atol=1e-15)
d = np.abs(f['trajectory/position'][()] - g['trajectory/position'][()])
assert d.max() < 1e-6, d.max()
assert f.attrs['frame_origin'] == "dense output: the library's interpolant" and f.attrs['frame_spacing'] == 'even'
)",
          {file("a.h5"), file("b.h5")});
}

TEST_F(Simulate, NamesTheFileAfterSceneAndMethodByDefault) {
  const ProcessResult result = run(scratch_.path(), {"simulate", "s.toml", "--method", "sundials:cvode_bdf",
                                                     "--rtol", "1e-6", "--atol", "1e-6", "--t-end", "1"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(scratch_.names(), ElementsAre("s-sundials_cvode_bdf.h5", "s.toml"));
}

TEST_F(Simulate, WritesXdmfOnRequest) {
  ASSERT_EQ(simulate("a.h5", {"--method", "rk4", "--step", "0.01", "--t-end", "1", "--xdmf"}).exit_code, 0);
  EXPECT_THAT(scratch_.names(), ElementsAre("a.h5", "a.xdmf", "s.toml"));
  EXPECT_THAT(store::test::read_bytes(scratch_ / "a.xdmf"), HasSubstr("a.h5:"));
}

/// The first two methods of each family that run with dampers: every engine is among them.
std::vector<catalog::MethodEntry> two_of_each_family() {
  std::map<std::string, int> taken;
  std::vector<catalog::MethodEntry> list;
  for (const catalog::MethodEntry& entry : catalog::methods()) {
    if (!entry.info().needs.has(Capability::position_forces) && ++taken[entry.info().family] <= 2)
      list.push_back(entry);
  }
  return list;
}

/// A name for a file of results of that method.
std::string file_of(std::string method, const std::string& ending) {
  std::replace(method.begin(), method.end(), ':', '-');
  return method + ending;
}

// Both tests run all methods before one Python looks at all files.
TEST_F(Simulate, GivesTheSameResultBitForBitWhenRunTwice) {
  std::vector<std::string> files;
  for (const catalog::MethodEntry& entry : two_of_each_family()) {
    Words arguments = {"--method", entry.name, "--t-end", "0.5"};
    if (entry.info().is_adaptive) {
      arguments.insert(arguments.end(), {"--rtol", "1e-6", "--atol", "1e-8"});
    } else {
      arguments.insert(arguments.end(), {"--step", "0.005"});
    }
    for (const std::string ending : {"-a.h5", "-b.h5"}) {
      const std::string name = file_of(entry.name, ending);
      ASSERT_EQ(simulate(name, arguments).exit_code, 0) << entry.name;
      files.push_back(file(name));
    }
  }
  ASSERT_GT(files.size(), 20u);
  inspect(R"(
for first, second in zip(sys.argv[1::2], sys.argv[2::2]):
    with h5py.File(first, 'r') as f, h5py.File(second, 'r') as g:
        try: assert same(f, g) > 15
        except AssertionError as difference: sys.exit(f'{first}, {second}: {difference}')
)",
          files);
}

TEST_F(Simulate, AnotherStepIsNotTheSameResult) {
  ASSERT_EQ(simulate("a.h5", {"--method", "rk4", "--step", "0.005", "--t-end", "0.5"}).exit_code, 0);
  ASSERT_EQ(simulate("b.h5", {"--method", "rk4", "--step", "0.0025", "--t-end", "0.5"}).exit_code, 0);
  inspect(
      "try: same(f, g)\n"
      "except AssertionError: sys.exit(0)\n"
      "sys.exit('the comparison sees no difference')\n",
      {file("a.h5"), file("b.h5")});
}

TEST_F(Simulate, LeavesFixedPointsWhereTheyAreBitForBit) {
  std::vector<std::string> files;
  for (const catalog::MethodEntry& entry : two_of_each_family()) {
    Words arguments = {"--method", entry.name, "--t-end", "1"};
    if (entry.info().is_adaptive) {
      arguments.insert(arguments.end(), {"--rtol", "1e-4", "--atol", "1e-6"});
    } else {
      arguments.insert(arguments.end(), {"--step", "0.005"});
    }
    const std::string name = file_of(entry.name, ".h5");
    ASSERT_EQ(simulate(name, arguments).exit_code, 0) << entry.name;
    files.push_back(file(name));
  }
  ASSERT_GT(files.size(), 10u);
  inspect(R"(
for path in sys.argv[1:]:
    with h5py.File(path, 'r') as f:
        x, v = f['trajectory/position'][()], f['trajectory/velocity'][()]
        assert list(f['system/fixed']) == [0], path
        assert x[:, 0].tobytes() == np.tile([0.1, 0.2, 0.3], (len(x), 1)).tobytes(), (path, x[:, 0] - x[0, 0])
        assert not v[:, 0].any(), path
        assert np.abs(x[-1, 1] - x[0, 1]).max() > 1e-2, path
)",
          files);
}

TEST_F(Simulate, DrawsNoProgressBarWhereStandardErrorIsNoTerminal) {
  const ProcessResult result =
      simulate("a.h5", {"--method", "rk4", "--step", "1e-6", "--t-end", "1", "--frames", "2"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_GT(result.seconds, 0.15) << "too short for a bar to be due";
  EXPECT_EQ(result.err, "");
  EXPECT_THAT(result.out, Not(HasSubstr("\r")));
}

TEST_F(Simulate, DrawsAProgressBarOnATerminalAndRemovesIt) {
  int terminal = -1, end = -1;
  if (::openpty(&terminal, &end, nullptr, nullptr, nullptr) != 0) {
    GTEST_SKIP() << "this machine has no pseudo-terminals (a chroot without /dev/pts)";
  }
  const ProcessResult result = run(scratch_.path(),
                                   {"simulate", "s.toml", "-o", "a.h5", "--method", "rk4", "--step", "1e-6",
                                    "--t-end", "2", "--frames", "2"},
                                   [&] { return ::dup2(end, STDERR_FILENO) >= 0; });
  ::close(end);
  std::string drawn;
  char buffer[4096];
  for (ssize_t size; (size = ::read(terminal, buffer, sizeof buffer)) > 0;) {
    drawn.append(buffer, static_cast<std::size_t>(size));
  }
  ::close(terminal);
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_GT(result.seconds, 0.15) << "too short for a bar to be due";
  EXPECT_THAT(drawn, AllOf(HasSubstr("[#"), HasSubstr("steps/s"), HasSubstr(" left  t = ")));
  EXPECT_TRUE(drawn.ends_with("\r\033[K")) << drawn;
}

TEST_F(Simulate, TellsAFailureToReadFromAnEmptyScene) {
  if (!std::filesystem::exists("/proc/self/mem")) GTEST_SKIP() << "/proc is not mounted";
  const ProcessResult result = run(scratch_.path(), {"simulate", "/proc/self/mem", "-o", "a.h5", "--method",
                                                     "rk4", "--step", "1", "--t-end", "1"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, HasSubstr("/proc/self/mem: reading failed: Input/output error"));
  EXPECT_THAT(scratch_.names(), ElementsAre("s.toml"));
}

TEST_F(Simulate, TakesNamesThatAreNotUtf8) {
  write_bytes(scratch_ / "\xff it's.toml", pendulum);
  const ProcessResult result = run(scratch_.path(), {"simulate", "\xff it's.toml", "--method", "rk4",
                                                     "--step", "0.1", "--t-end", "1", "-o", "\xff.h5"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  std::filesystem::rename(scratch_ / "\xff.h5", scratch_ / "a.h5");
  inspect("assert \"\\ufffd it'\\\\''s.toml\" in f.attrs['command_line'], f.attrs['command_line']\n",
          {file("a.h5")});
}

TEST_F(Simulate, KeepsWhatIsFinishedWhenInterrupted) {
  for (const int signal : {SIGINT, SIGTERM}) {
    Process process(scratch_.path(), {"simulate", "s.toml", "-o", "a.h5", "--method", "rk4", "--step", "1e-6",
                                      "--t-end", "1e4", "--frames", "100000001"});
    ::usleep(500'000);
    process.send(signal);
    const ProcessResult result = process.wait();
    EXPECT_EQ(result.exit_code, 3) << result.signal;
    EXPECT_THAT(result.err, HasSubstr("interrupted by the user at t = "));
    EXPECT_THAT(scratch_.names(), ElementsAre("a.h5", "s.toml"));
    inspect(
        "assert f.attrs['status'] == 'incomplete' and f.attrs['solver_status'].startswith('interrupted')\n"
        "t = f['trajectory/time'][()]\n"
        "assert len(t) > 2 and (np.diff(t) > 0).all() and len(f['trajectory/position']) == len(t)\n",
        {file("a.h5")});
    EXPECT_EQ(run(scratch_.path(), {"show", "a.h5"}).exit_code, 0);
  }
}

TEST_F(Simulate, KeepsTheStatesBeforeABlowUp) {
  write_bytes(scratch_ / "s.toml",
              "[particles]\nposition = [[0,0,0], [1.1,0,0]]\nmass = 1\nfixed = [0]\n"
              "[springs]\nbetween = [[0,1]]\nstiffness = 1e6\nrest_length = 1\n");
  const ProcessResult result =
      simulate("a.h5", {"--method", "explicit_euler", "--step", "0.1", "--t-end", "100"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, ::testing::AnyOf(HasSubstr("non_finite"), HasSubstr("blow_up")));
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  EXPECT_THAT(scratch_.names(), ElementsAre("a.h5", "s.toml"));
  inspect(R"(
assert f.attrs['status'] == 'incomplete'
assert f.attrs['solver_status'].startswith(('non_finite', 'blow_up')), f.attrs['solver_status']
x = f['trajectory/position'][()]
assert 1 < len(x) < 101 and np.isfinite(x).all() and f['trajectory/time'][-1] < 100
)",
          {file("a.h5")});
}

TEST_F(Simulate, LeavesAFileAsItIsWhereTheMethodCannotSolveTheScene) {
  ASSERT_EQ(simulate("a.h5", {"--method", "rk4", "--step", "0.01", "--t-end", "0.1"}).exit_code, 0);
  const std::string before = read_bytes(scratch_ / "a.h5");
  const ProcessResult refused =
      simulate("a.h5", {"--method", "nystrom4", "--step", "0.01", "--t-end", "0.1"});
  EXPECT_EQ(refused.exit_code, 2) << refused.out;
  EXPECT_THAT(refused.err, Not(HasSubstr("replaced")));
  EXPECT_EQ(read_bytes(scratch_ / "a.h5"), before);
}

TEST_F(Simulate, SpeaksOfLostEnergyWhereAnyForceDependsOnVelocities) {
  const std::string undamped =
      "[particles]\nposition = [[0, 0, 0], [1, 0, 0]]\nvelocity = [[0, 0, 0], [1, 0, 0]]\nmass = 1\n"
      "fixed = [0]\n[springs]\nbetween = [[0, 1]]\nstiffness = 100\n";
  const auto shown = [&](const std::string& scene) {
    write_bytes(scratch_ / "s.toml", scene);
    EXPECT_EQ(simulate("a.h5", {"--method", "rk4", "--step", "0.01", "--t-end", "1"}).exit_code, 0);
    return run(scratch_.path(), {"show", "a.h5"}).out;
  };
  EXPECT_THAT(shown(undamped), HasSubstr("energy drift"));
  EXPECT_THAT(shown(undamped + "damping = 0.5\n"), Not(HasSubstr("energy drift")));
  EXPECT_THAT(shown("[world]\nrayleigh = { mass = 0.5 }\n" + undamped), Not(HasSubstr("energy drift")));
  EXPECT_THAT(shown("[world]\ndrag = 0.5\n" + undamped), Not(HasSubstr("energy drift")));
}

TEST_F(Simulate, GivesVelocitiesAToleranceOfTheirOwn) {
  const Words common = {"--method", "dormand_prince_54", "--rtol", "1e-12", "--atol", "1e-3", "--t-end", "1"};
  const auto with = [&](const std::string& output, const Words& more) {
    Words words = common;
    words.insert(words.end(), more.begin(), more.end());
    return simulate(output, words);
  };
  EXPECT_EQ(with("a.h5", {}).exit_code, 0);
  EXPECT_EQ(with("b.h5", {"--atol-velocity", "1e-3"}).exit_code, 0);
  EXPECT_EQ(with("c.h5", {"--atol-velocity", "1e-9"}).exit_code, 0);
  inspect("assert np.array_equal(f['trajectory/position'], g['trajectory/position'])\n",
          {file("a.h5"), file("b.h5")});
  inspect("assert g['counters/accepted_steps'][()] > 1.5 * f['counters/accepted_steps'][()]\n",
          {file("a.h5"), file("c.h5")});
  for (const char* bad : {"0", "-1e-3", "nan", "inf"}) {
    const ProcessResult refused = with("d.h5", {"--atol-velocity", bad});
    EXPECT_EQ(refused.exit_code, 2) << bad;
    EXPECT_THAT(refused.err, HasSubstr("--atol-velocity: found ")) << bad;
  }
  const ProcessResult fixed =
      simulate("d.h5", {"--method", "rk4", "--step", "0.1", "--t-end", "1", "--atol-velocity", "1e-3"});
  EXPECT_EQ(fixed.exit_code, 2);
  EXPECT_THAT(fixed.err, HasSubstr("found --step and tolerances"));
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "d.h5"));
}

}  // namespace
}  // namespace fw::app::test
