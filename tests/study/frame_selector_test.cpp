#include "record/frame_selector.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "catalog/methods.hpp"
#include "core/error.hpp"
#include "oracles/sundials/cvode.hpp"
#include "problems/oscillators.hpp"

namespace fw::study {
namespace {

class Frames final : public record::FrameSink {
 public:
  void frame(double time, ConstVectorRef state) override {
    times.push_back(time);
    states.emplace_back(state);
  }
  std::vector<double> times;
  std::vector<Vector> states;
};

Frames frames_of(const Integrator& integrator, const StepControl& control, std::uint64_t count, double end) {
  Problem problem = problems::harmonic_oscillator();
  problem.ivp.t1 = end;
  Frames frames;
  record::FrameSelector selector(0.0, end, control, count, frames);
  EXPECT_TRUE(integrator.solve(problem.ivp, control, selector).status.ok());
  EXPECT_EQ(selector.written(), selector.expected());
  return frames;
}

TEST(FrameSelector, TakesTheStepTimesNearestToAnEqualSpacing) {
  const FixedStep control{.step = 0.01};
  const Frames frames = frames_of(*catalog::make_method("velocity_verlet"), control, 7, 1.0);
  ASSERT_EQ(frames.times.size(), 7u);
  EXPECT_EQ(frames.times.front(), 0.0);
  EXPECT_EQ(frames.times.back(), 1.0);
  for (std::size_t k = 0; k < 7; ++k) {
    EXPECT_LE(std::abs(frames.times[k] - static_cast<double>(k) / 6.0), 0.005 + 1e-12);
    EXPECT_NEAR(std::remainder(frames.times[k], 0.01), 0.0, 1e-12);  // a true step time
  }
}

TEST(FrameSelector, StoresEveryStateOnceWhereThereAreFewerStepsThanFrames) {
  const Frames frames =
      frames_of(*catalog::make_method("velocity_verlet"), FixedStep{.step = 0.25}, 101, 1.0);
  EXPECT_EQ(frames.times, (std::vector<double>{0.0, 0.25, 0.5, 0.75, 1.0}));
}

TEST(FrameSelector, StoresEveryStateForEveryCountOfSteps) {
  for (std::uint64_t steps = 1; steps <= 60; ++steps) {
    for (std::uint64_t count : {steps + 1, steps, steps / 2 + 2}) {
      if (count < 2) continue;
      const Frames frames = frames_of(*catalog::make_method("velocity_verlet"),
                                      FixedStep{.step = 1.0 / static_cast<double>(steps)}, count, 1.0);
      ASSERT_EQ(frames.times.size(), std::min(count, steps + 1)) << steps << " steps, " << count << " frames";
      EXPECT_EQ(frames.times.back(), 1.0);
    }
  }
}

TEST(FrameSelector, KeepsTheEndOfAShorterLastStep) {
  const Frames frames = frames_of(*catalog::make_method("velocity_verlet"), FixedStep{.step = 0.3}, 101, 1.0);
  ASSERT_EQ(frames.times.size(), 5u);
  EXPECT_EQ(frames.times.back(), 1.0);
}

TEST(FrameSelector, InterpolatesAdaptiveRunsAtEqualSpacing) {
  const AdaptiveStep control{.relative_tolerance = 1e-10, .absolute_tolerance = 1e-12};
  const Frames frames = frames_of(*oracles::make_cvode_bdf(), control, 11, 2.0);
  const Problem problem = problems::harmonic_oscillator();
  ASSERT_EQ(frames.times.size(), 11u);
  for (std::size_t k = 0; k < 11; ++k) {
    EXPECT_DOUBLE_EQ(frames.times[k], 0.2 * static_cast<double>(k));
    EXPECT_NEAR(frames.states[k][0], static_cast<double>(problem.exact(frames.times[k])[0]), 1e-7);
  }
  EXPECT_EQ(frames.times.back(), 2.0);
}

TEST(FrameSelector, RefusesFewerThanTwoFrames) {
  Frames frames;
  EXPECT_THROW(record::FrameSelector(0.0, 1.0, FixedStep{.step = 0.1}, 1, frames), InputError);
}

}  // namespace
}  // namespace fw::study
