#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/result_text.hpp"
#include "app/simulate_fixture.hpp"

namespace fw::app::test {
namespace {

using store::test::write_bytes;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

/// A particle that meets a plate of 2 mm after 0.5 s at 10 m/s.
const std::string plate = R"([particles]
position = [[0, 0, 0]]
velocity = [[10, 0, 0]]
mass = 1.0
[[obstacle]]
shape = "box"
lower = [5, -1, -1]
upper = [5.002, 1, 1]
stiffness = 1e9
)";

TEST_F(Simulate, EndsStepsAtAThinPlateAndTellsOfIt) {
  write_bytes(scratch_ / "s.toml", plate);
  const ProcessResult result =
      simulate("a.h5", {"--method", "dormand_prince_54", "--rtol", "1e-8", "--atol", "1e-8", "--t-end", "1",
                        "--log-at", "contact", "--log-at", "release:0", "--log-at", "plane:1,0,0,2"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
  EXPECT_THAT(result.out, AllOf(HasSubstr("t = 0.5 s: contact: obstacles[0] and particle 0"),
                                HasSubstr("t = 0.500099346 s: release:0: obstacles[0] and particle 0")));
  inspect(R"(
x = f['trajectory/position'][-1, 0, 0]
assert abs(x - (5 - 10 * (0.5 - np.pi / 1e9 ** 0.5))) < 1e-7, x
assert len(f['events/time']) == 4 and f['events/time'].attrs['unit'] == 's'
assert abs(f['events/time'][1] - 0.5) < 1e-9 and abs(f['events/time'][2] - 0.5 - np.pi / 1e9 ** 0.5) < 1e-9
assert 'warnings' not in f.attrs
)",
          {file("a.h5")});
}

TEST_F(Simulate, StopsAtAnEvent) {
  write_bytes(scratch_ / "s.toml", plate);
  const ProcessResult result =
      simulate("a.h5", {"--method", "sundials:cvode_bdf", "--rtol", "1e-8", "--atol", "1e-8", "--t-end", "1",
                        "--stop-at", "contact", "--maximum-step", "0.01"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, HasSubstr("stopped at t = 0.5 s: contact"));
  inspect(R"(
assert abs(f['trajectory/time'][-1] - 0.5) < 1e-9 and abs(f['trajectory/position'][-1, 0, 0] - 5) < 1e-8
assert f.attrs['status'] == 'complete' and 'obstacles[0] and particle 0' in f.attrs['stopped_at']
assert f['counters/accepted_steps'][()] >= 50
)",
          {file("a.h5")});
}

TEST_F(Simulate, WarnsWhereAConstantStepIsTooLongForAContact) {
  write_bytes(scratch_ / "s.toml", plate);
  const ProcessResult result = simulate("a.h5", {"--method", "rk4", "--step", "0.001", "--t-end", "1"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, AllOf(HasSubstr("federwerk: warning: contact of obstacles[0] and particle 0"),
                                HasSubstr("h sqrt(k/m) is 31.6"), HasSubstr("the solid is 0.002 m thick")));
  inspect(R"(
assert len(f.attrs['warnings'].split('\n')) == 2
)",
          {file("a.h5")});
  EXPECT_THAT(run(scratch_.path(), {"show", "a.h5"}).out, HasSubstr("warning   contact of obstacles[0]"));
}

TEST_F(Simulate, RefusesEventsThatItDoesNotKnow) {
  const Words method{"--method", "dormand_prince_54", "--rtol", "1e-8",    "--atol",
                     "1e-8",     "--t-end",           "1",      "--log-at"};
  for (const auto& [event, why] :
       std::map<std::string, std::string>{{"bounce", "expected an event"},
                                          {"contact", "the scene has no obstacle and no rope"},
                                          {"plane:1,0,0", "expected four numbers"},
                                          {"plane:0,0,0,1", "a normal that is not zero"},
                                          {"plane:1,0,0,0:3", "the number of a particle from 0 to 2"},
                                          {"energy:magnetic", "expected the name of an energy"},
                                          {"energy:kinetic:1", "expected the number"}}) {
    Words all = method;
    all.push_back(event);
    const ProcessResult result = simulate("a.h5", all);
    EXPECT_EQ(result.exit_code, 2) << event;
    EXPECT_THAT(result.err, AllOf(HasSubstr("--log-at"), HasSubstr(why))) << event;
  }
  EXPECT_THAT(scratch_.names(), ElementsAre("s.toml"));
}

}  // namespace
}  // namespace fw::app::test
