#include "study/measure/step_ladder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace fw::study {
namespace {

std::vector<std::int64_t> steps_of(const std::vector<LadderStep>& ladder) {
  std::vector<std::int64_t> steps;
  for (const LadderStep& rung : ladder) steps.push_back(rung.steps);
  return steps;
}

TEST(DoubleSteps, StopsAtTheFirstAcceptedRunAndNamesTheOneBefore) {
  std::vector<std::int64_t> tried;
  const DoubledSteps<double> found = double_steps(3, 1000, [&](std::int64_t steps) -> std::optional<double> {
    tried.push_back(steps);
    if (steps < 20) return std::nullopt;
    return 0.5 * static_cast<double>(steps);
  });
  EXPECT_EQ(tried, (std::vector<std::int64_t>{3, 6, 12, 24}));
  ASSERT_TRUE(found.run);
  EXPECT_EQ(*found.run, 12.0);
  EXPECT_EQ(found.steps, 24);
  EXPECT_EQ(found.rejected, 12);
}

TEST(DoubleSteps, HasNoRejectedRunWhereTheFirstIsAccepted) {
  const DoubledSteps<int> found = double_steps(8, 8, [](std::int64_t) { return std::optional<int>(7); });
  EXPECT_EQ(found.run, 7);
  EXPECT_EQ(found.steps, 8);
  EXPECT_EQ(found.rejected, 0);
}

TEST(DoubleSteps, NeverRunsWithMoreThanTheMost) {
  std::int64_t largest = 0;
  const DoubledSteps<int> found = double_steps(8, 63, [&](std::int64_t steps) {
    largest = std::max(largest, steps);
    return std::optional<int>();
  });
  EXPECT_FALSE(found.run);
  EXPECT_EQ(largest, 32);
}

TEST(StepLadder, HasTheNearestIntegersOfAGeometricSequence) {
  const std::vector<LadderStep> ladder = step_ladder(10, 1.5, 5, 1000);
  EXPECT_EQ(steps_of(ladder), (std::vector<std::int64_t>{10, 15, 23, 34, 51}));  // 22.5, 33.75, 50.625
  for (std::size_t k = 0; k < ladder.size(); ++k) EXPECT_EQ(ladder[k].level, static_cast<std::int64_t>(k));
}

TEST(StepLadder, LeavesOutRepetitionsAndKeepsTheirLevels) {
  const std::vector<LadderStep> ladder =
      step_ladder(2, 1.1, 8, 1000);  // 2, 2.2, 2.42, 2.66, 2.93, 3.2, 3.5, 3.9
  EXPECT_EQ(steps_of(ladder), (std::vector<std::int64_t>{2, 3, 4}));
  EXPECT_EQ(ladder[1].level, 3);
  EXPECT_EQ(ladder[2].level, 6);
}

TEST(StepLadder, EndsAtTheMost) {
  EXPECT_EQ(steps_of(step_ladder(8, 2.0, 100, 64)), (std::vector<std::int64_t>{8, 16, 32, 64}));
  EXPECT_TRUE(step_ladder(8, 2.0, 100, 7).empty());
}

TEST(StepLadder, MakesStepsThatDivideTheInterval) {
  Ivp ivp;
  ivp.t0 = 1.0;
  ivp.t1 = 4.0;
  const FixedStep control = constant_steps(ivp, 7);
  EXPECT_EQ(control.step, 3.0 / 7.0);
  EXPECT_FALSE(control.allow_short_last_step);
  const AdaptiveStep chosen = chosen_steps(1e-3, 0.25, 90);
  EXPECT_EQ(chosen.relative_tolerance, 1e-3);
  EXPECT_EQ(chosen.absolute_tolerance, 0.25e-3);
  EXPECT_EQ(chosen.maximum_steps, 90u);
  EXPECT_EQ(affordable_steps(MethodInfo{.stages = 4}, 1001), 250);
  EXPECT_EQ(affordable_steps(MethodInfo{.stages = 0}, 1001), 1001);  // foreign solvers do not tell
}

}  // namespace
}  // namespace fw::study
