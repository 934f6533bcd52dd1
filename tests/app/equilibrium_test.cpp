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
  EXPECT_THAT(bad.err, HasSubstr("start: found \"equilibirum\""));
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
