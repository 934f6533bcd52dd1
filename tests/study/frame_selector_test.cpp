#include "record/frame_selector.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

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

Frames frames_of(const Integrator& integrator, const StepControl& control, std::optional<std::uint64_t> count,
                 double end) {
  Problem problem = problems::harmonic_oscillator();
  problem.ivp.t1 = end;
  Frames frames;
  const record::FramePlan plan(0.0, end, control, count);
  record::FrameSelector selector(plan, frames);
  EXPECT_TRUE(integrator.solve(problem.ivp, control, selector).status.ok());
  EXPECT_EQ(selector.written(), plan.count());
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

TEST(FrameSelector, SpacesFramesOfConstantStepsEvenlyByDefault) {
  const auto method = catalog::make_method("velocity_verlet");
  for (std::uint64_t steps = 1; steps <= 420; ++steps) {
    const double h = 1.0 / 64.0, end = static_cast<double>(steps) * h;
    const Frames frames = frames_of(*method, FixedStep{.step = h}, std::nullopt, end);
    const std::size_t intervals = frames.times.size() - 1;
    const double spacing = frames.times[1];
    EXPECT_EQ(frames.times.back(), end);
    for (std::size_t k = 0; k + 1 < frames.times.size(); ++k) {
      ASSERT_EQ(frames.times[k], static_cast<double>(k) * spacing) << steps;
    }
    const record::FramePlan plan(0.0, end, FixedStep{.step = h}, std::nullopt);
    const record::FrameOrigin origin =
        plan.origin(method->info(), *problems::harmonic_oscillator().ivp.system);
    EXPECT_EQ(origin.states, "ends of steps");
    const bool is_even = end - frames.times[intervals - 1] == spacing;
    EXPECT_EQ(origin.spacing, is_even ? "even" : "even but for the last") << steps;
    const std::size_t least = std::min<std::size_t>(steps, 50),
                      most = std::max<std::size_t>(std::min<std::size_t>(steps, 100), steps > 100 ? 200 : 0);
    EXPECT_GE(intervals, steps <= 100 ? steps : least) << steps;
    EXPECT_LE(intervals, most) << steps;
  }
}

TEST(FrameSelector, TakesTheNumberOfIntervalsNearestToAHundred) {
  const auto intervals = [](std::uint64_t steps) {
    return record::FramePlan(0.0, static_cast<double>(steps), FixedStep{.step = 1.0}, std::nullopt).count() -
           1;
  };
  EXPECT_EQ(intervals(1000), 100u);
  EXPECT_EQ(intervals(250), 125u);
  EXPECT_EQ(intervals(144), 72u);
  EXPECT_EQ(intervals(2 * 997), 100u);  // of 20 steps each but for the last: neither 2 nor 997 is near
  EXPECT_EQ(intervals(9007199254740000u), 100u);  // found without a search through all of them
}

TEST(FrameSelector, SaysHowFramesCameAbout) {
  const auto origin = [](const std::string& method, const StepControl& control,
                         std::optional<std::uint64_t> frames) {
    const record::FrameOrigin found =
        record::FramePlan(0.0, 1.0, control, frames)
            .origin(catalog::make_method(method)->info(), *problems::harmonic_oscillator().ivp.system);
    return found.states + "; " + found.spacing;
  };
  const AdaptiveStep tolerances{};
  EXPECT_EQ(origin("rk4", FixedStep{.step = 0.001}, 301), "ends of steps; uneven");
  EXPECT_EQ(origin("rk4", FixedStep{.step = 0.001}, 251), "ends of steps; even");
  EXPECT_EQ(origin("rk4", FixedStep{.step = 0.3}, 101), "ends of steps; even but for the last");
  EXPECT_EQ(origin("rk4", FixedStep{.step = 0.3}, 3), "ends of steps; uneven");
  EXPECT_EQ(origin("verner_87", tolerances, 11),
            "dense output of order 8: polynomials through states of the scheme inside the step; even");
  EXPECT_EQ(origin("rodas4", tolerances, std::nullopt),
            "dense output of order 4: side steps of the scheme; even");
  EXPECT_EQ(origin("bogacki_shampine_32", tolerances, std::nullopt),
            "dense output of order 3: cubic Hermite polynomials; even");
  EXPECT_EQ(origin("sundials:cvode_bdf", tolerances, std::nullopt),
            "dense output: the library's interpolant; even");
}

TEST(FrameSelector, RefusesFewerThanTwoFrames) {
  EXPECT_THROW(record::FramePlan(0.0, 1.0, FixedStep{.step = 0.1}, 1), InputError);
  EXPECT_THROW(record::FramePlan(0.0, 1.0, AdaptiveStep{}, 0), InputError);
}

}  // namespace
}  // namespace fw::study
