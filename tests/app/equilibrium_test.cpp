#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "app/process.hpp"
#include "store/scratch_directory.hpp"

namespace fw::app::test {
namespace {

using ::testing::HasSubstr;

/// Two masses below each other on springs of 100 N/m under 10 m/s²: they hang 0.3 m and 0.2 m longer.
const std::string hanging_pair =
    "[world]\ngravity = [0, 0, -10]\n[particles]\nposition = [[0,0,0], [0,0,-1], [0,0,-2]]\nmass = [1, 1, "
    "2]\n"
    "fixed = [0]\n[springs]\nbetween = [[0,1], [1,2]]\nstiffness = 100\nrest_length = 1\n";

/// The number after "key": in a JSON text.
double number_of(const std::string& json, const std::string& key) {
  const std::size_t at = json.find("\"" + key + "\":");
  return at == std::string::npos ? std::nan("") : std::stod(json.substr(at + key.size() + 3));
}

TEST(Equilibrium, OfHangingMassesIsThatOfHookesLaw) {
  const store::test::ScratchDirectory scratch;
  store::test::write_bytes(scratch / "pair.toml", hanging_pair);
  for (const std::string solver : {"kinsol", "snes"}) {
    const ProcessResult result =
        run(scratch.path(), {"equilibrium", "pair.toml", "--json", "--solver", solver});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NEAR(number_of(result.out, "largest_displacement"), 0.5, 1e-10) << solver;
    EXPECT_NEAR(number_of(result.out, "farthest_particle"), 2.0, 0.0);
    // Energy of springs ½·100·(0.3² + 0.2²) = 6.5 J less what the masses have fallen, 10·0.3 + 20·0.5 = 13 J.
    EXPECT_NEAR(number_of(result.out, "potential_energy") - number_of(result.out, "potential_energy_start"),
                -6.5, 1e-9);
    EXPECT_THAT(result.out, HasSubstr("\"stability\": \"stable\""));
    // Across, a mass swings like a pendulum under the tension T/L: 30/1.3 and 20/1.2 N/m.
    const double a = 30.0 / 1.3 + 20.0 / 1.2, b = 20.0 / 1.2;
    const double half = 0.5 * (a + 0.5 * b), det = 0.5 * (a * b - b * b);
    EXPECT_NEAR(number_of(result.out, "lowest_omega_squared"), half - std::sqrt(half * half - det), 1e-7);
  }
}

TEST(Equilibrium, OfACompressedColumnIsUnstable) {
  const store::test::ScratchDirectory scratch;
  store::test::write_bytes(scratch / "column.toml",
                           "[particles]\nposition = [[0,0,0], [0,0,1], [0,0,2]]\nmass = 1\nfixed = [0, 2]\n"
                           "[springs]\nbetween = [[0,1], [1,2]]\nstiffness = 100\nrest_length = 1.25\n");
  const ProcessResult result = run(scratch.path(), {"equilibrium", "column.toml"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  // Across: −2 T/L = −2·25 N/m on 1 kg, e-fold in 1/√50 s.
  EXPECT_THAT(result.out, HasSubstr("unstable, a disturbance grows e-fold in 0.141 s"));
}

TEST(Equilibrium, IsNotFoundWhereNothingHolds) {
  const store::test::ScratchDirectory scratch;
  store::test::write_bytes(scratch / "falls.toml",
                           "[world]\ngravity = [0, 0, -10]\n[particles]\nposition = [[0,0,0]]\nmass = 1\n");
  const ProcessResult result = run(scratch.path(), {"equilibrium", "falls.toml", "-o", "out.h5"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, HasSubstr("falls.toml: no static equilibrium was found, largest force 10 N"));
  EXPECT_THAT(scratch.names(), ::testing::ElementsAre("falls.toml"));
  store::test::write_bytes(scratch / "fixed.toml",
                           "[particles]\nposition = [[0,0,0]]\nmass = 1\nfixed = [0]\n");
  const ProcessResult fixed = run(scratch.path(), {"equilibrium", "fixed.toml"});
  EXPECT_EQ(fixed.exit_code, 2);
  EXPECT_THAT(fixed.err, HasSubstr("no particle can move"));
  const ProcessResult wrong = run(scratch.path(), {"equilibrium", "fixed.toml", "--solver", "kinso"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("did you mean \"kinsol\"?"));
}

TEST(Equilibrium, IsWhereAStudyStartsOnRequest) {
  const store::test::ScratchDirectory scratch;
  store::test::write_bytes(scratch / "pair.toml", "start = 'equilibrium'\n" + hanging_pair);
  store::test::write_bytes(scratch / "rest.toml",
                           "kind = 'simulate'\ntitle = 'T'\nmethods = ['rk4']\nsteps = [0.01]\n[[problem]]\n"
                           "scene = 'pair.toml'\nt_end = 1.0\n");
  const ProcessResult result = run(scratch.path(), {"run", "rest.toml"});
  ASSERT_EQ(result.exit_code, 0) << result.err << result.out;
  store::test::write_bytes(scratch / "bad.toml", "start = 'equilibirum'\n" + hanging_pair);
  const ProcessResult bad = run(scratch.path(), {"check", "bad.toml"});
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_THAT(bad.err, HasSubstr("start: found the string \"equilibirum\""));
}

TEST(SimulateFrom, StartsFromTheLastFrameOfAResult) {
  const store::test::ScratchDirectory scratch;
  store::test::write_bytes(scratch / "pair.toml", hanging_pair);
  const auto energy_of = [&](const std::string& file) {
    const ProcessResult shown = run(scratch.path(), {"show", file, "--json"});
    return number_of(shown.out, "kinetic_energy_end");
  };
  ASSERT_EQ(run(scratch.path(), {"equilibrium", "pair.toml", "-o", "rest.h5"}).exit_code, 0);
  const ProcessResult result =
      run(scratch.path(), {"simulate", "pair.toml", "--method", "rk4", "--step", "0.01", "--t-end", "1",
                           "--from", "rest.h5", "-o", "still.h5"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_LT(energy_of("still.h5"), 1e-20);
  // The first half of a run and the second from its end are the whole run.
  const std::vector<std::string> common = {"simulate", "pair.toml", "--method", "rk4", "--step", "0.01"};
  const auto simulate = [&](std::vector<std::string> more) {
    std::vector<std::string> words = common;
    words.insert(words.end(), more.begin(), more.end());
    const ProcessResult run_result = run(scratch.path(), words);
    EXPECT_EQ(run_result.exit_code, 0) << run_result.err;
  };
  simulate({"--t-end", "1", "-o", "whole.h5"});
  simulate({"--t-end", "0.5", "-o", "first.h5"});
  simulate({"--t-end", "0.5", "--from", "first.h5", "-o", "second.h5"});
  EXPECT_GT(energy_of("whole.h5"), 0.1);
  EXPECT_NEAR(energy_of("second.h5"), energy_of("whole.h5"), 1e-12);

  store::test::write_bytes(scratch / "one.toml", "[particles]\nposition = [[0,0,0]]\nmass = 1\n");
  const ProcessResult other = run(scratch.path(), {"simulate", "one.toml", "--method", "rk4", "--step",
                                                   "0.01", "--t-end", "1", "--from", "rest.h5"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, HasSubstr("\"rest.h5\" has 3 particles, expected 1 as in the scene"));
  const ProcessResult scene = run(scratch.path(), {"simulate", "pair.toml", "--method", "rk4", "--step",
                                                   "0.01", "--t-end", "1", "--from", "pair.toml"});
  EXPECT_EQ(scene.exit_code, 2);
}

TEST(StepAdvice, NamesTheLargestStableStepAndWarnsAboveIt) {
  const store::test::ScratchDirectory scratch;
  store::test::write_bytes(scratch / "one.toml",
                           "[particles]\nposition = [[0,0,0], [1.01,0,0]]\nmass = 1\nfixed = [0]\n[springs]\n"
                           "between = [[0,1]]\nstiffness = 400\nrest_length = 1\n");
  const auto simulate = [&](const std::string& method, const std::string& step) {
    return run(scratch.path(), {"simulate", "one.toml", "--method", method, "--step", step, "--t-end", "0.6",
                                "-o", method + step + ".h5"});
  };
  const ProcessResult good = simulate("velocity_verlet", "0.05");
  EXPECT_EQ(good.exit_code, 0);
  EXPECT_THAT(good.out, HasSubstr("the step is 0.5 of the largest stable one at the start, 0.1 s in theory"));
  EXPECT_EQ(good.err, "");
  EXPECT_THAT(simulate("velocity_verlet", "0.12").err,
              HasSubstr("warning: the step 0.12 s is above the largest stable"));
  EXPECT_THAT(simulate("explicit_euler", "0.001").out, HasSubstr("an undamped mode grows at every step"));
  EXPECT_THAT(simulate("implicit_euler", "0.2").out, ::testing::Not(HasSubstr("stable")));
}

TEST(DescribeScene, TellsMassesSpringsAndStableSteps) {
  const store::test::ScratchDirectory scratch;
  // One mass on a spring of 400 N/m along x: ω = 20 rad/s.
  store::test::write_bytes(scratch / "one.toml",
                           "[particles]\nposition = [[0,0,0], [1,0,0]]\nmass = 1\nfixed = [0]\n[springs]\n"
                           "between = [[0,1]]\nstiffness = 400\n");
  const ProcessResult result = run(scratch.path(), {"describe", "one.toml"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("springs[0] [0, 1]           400 N/m, 20 rad/s"));
  EXPECT_THAT(result.out, HasSubstr("explicit_euler           none: an undamped mode grows at every step"));
  EXPECT_THAT(result.out, HasSubstr("velocity_verlet          100 ms"));    // 2/ω
  EXPECT_THAT(result.out, HasSubstr("rk4                      141.4 ms"));  // 2√2/ω
  EXPECT_THAT(result.out, HasSubstr("implicit_euler           no limit"));
  const ProcessResult json = run(scratch.path(), {"describe", "one.toml", "--json"});
  EXPECT_NEAR(number_of(json.out, "fastest_vibration"), 20.0, 1e-9);
  const ProcessResult missing = run(scratch.path(), {"describe", "two.toml"});
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_THAT(missing.err, HasSubstr("two.toml: no such file"));
}

}  // namespace
}  // namespace fw::app::test
