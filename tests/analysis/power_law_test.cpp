#include "analysis/fit/power_law.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace fw::analysis {
namespace {

TEST(PowerLaw, FindsExponentAndFactorOfExactData) {
  const std::vector<double> x = {1, 2, 5, 10, 100};
  std::vector<double> y;
  for (const double value : x) y.push_back(3.0 * std::pow(value, -0.5));
  const PowerLaw law = fit_power_law(x, y);
  ASSERT_TRUE(law.valid) << law.reason;
  EXPECT_NEAR(law.exponent, -0.5, 1e-14);
  EXPECT_NEAR(law.factor, 3.0, 1e-13);
  EXPECT_NEAR(law.correlation, -1.0, 1e-14);
  EXPECT_NEAR(law(4.0), 1.5, 1e-13);
  EXPECT_EQ(law.points, 5);
}

TEST(PowerLaw, HasAnIntervalThatHoldsTheExponentNineteenTimesInTwenty) {
  std::mt19937_64 engine(7);
  std::normal_distribution<double> noise(0.0, 0.05);
  int held = 0;
  constexpr int trials = 2000;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<double> x, y;
    for (int k = 0; k < 8; ++k) {
      x.push_back(std::pow(2.0, k));
      y.push_back(std::pow(x.back(), 1.5) * std::exp(noise(engine)));
    }
    const PowerLaw law = fit_power_law(x, y);
    held += law.exponent_low <= 1.5 && 1.5 <= law.exponent_high;
  }
  EXPECT_NEAR(static_cast<double>(held) / trials, 0.95, 0.015);  // three standard deviations
}

TEST(PowerLaw, LeavesOutWhatHasNoLogarithmAndSaysWhenTooLittleIsLeft) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> x = {1, 2, 3, 4, 5}, y = {1, nan, 9, -1, 25};
  const PowerLaw law = fit_power_law(x, y);
  ASSERT_TRUE(law.valid);
  EXPECT_EQ(law.points, 3);
  EXPECT_NEAR(law.exponent, 2.0, 1e-13);
  EXPECT_FALSE(fit_power_law(std::vector<double>{1, 2}, std::vector<double>{1, 2}).valid);
  EXPECT_FALSE(fit_power_law(std::vector<double>{2, 2, 2}, std::vector<double>{1, 2, 3}).valid);
}

TEST(FindCrossing, FindsWherePowerLawsMeet) {
  const std::vector<double> x = {1, 10, 100, 1000}, exact = {1, 1, 1, 1};
  std::vector<double> rising, flat;
  for (const double value : x) {
    rising.push_back(0.2 * std::sqrt(value));
    flat.push_back(3.0);
  }
  const Crossing crossing = find_crossing(x, rising, flat, exact, exact);
  ASSERT_TRUE(crossing.valid) << crossing.reason;
  EXPECT_NEAR(crossing.x, 225.0, 1e-9);
  EXPECT_NEAR(crossing.low, 225.0, 1e-9);
  EXPECT_NEAR(crossing.high, 225.0, 1e-9);
  const std::vector<double> spread = {1.1, 1.1, 1.1, 1.1};
  const Crossing uncertain = find_crossing(x, rising, flat, spread, exact);
  EXPECT_NEAR(uncertain.low, 225.0 / 1.21, 1e-9);
  EXPECT_NEAR(uncertain.high, 225.0 * 1.21, 1e-9);
  EXPECT_NEAR(find_crossing(x, flat, rising, exact, spread).high, 225.0 * 1.21, 1e-9);
}

TEST(FindCrossing, SaysWhereThereIsNoneOrMoreThanOne) {
  const std::vector<double> x = {1, 2, 3, 4}, one = {1, 1, 1, 1};
  EXPECT_FALSE(
      find_crossing(x, std::vector<double>{1, 2, 3, 4}, std::vector<double>{5, 6, 7, 8}, one, one).valid);
  EXPECT_FALSE(
      find_crossing(x, std::vector<double>{1, 3, 1, 3}, std::vector<double>{2, 2, 2, 2}, one, one).valid);
}

TEST(FindCrossing, IsBoundedByTheRangeWhereTheSpreadHidesIt) {
  const std::vector<double> x = {1, 10, 100}, one = {1, 1, 1}, wide = {100, 100, 100};
  const Crossing crossing =
      find_crossing(x, std::vector<double>{1, 2, 4}, std::vector<double>{3, 3, 3}, wide, one);
  ASSERT_TRUE(crossing.valid);
  EXPECT_EQ(crossing.low, 1.0);
  EXPECT_NEAR(crossing.high, 100.0, 1e-12);
}

TEST(PowerLaw, SupportsAnExponentByItsIntervalOnly) {
  const auto law = [](double exponent, double low, double high) {
    return PowerLaw{.valid = true, .exponent = exponent, .exponent_low = low, .exponent_high = high};
  };
  EXPECT_EQ(judge_exponent(law(2.001, 1.99, 2.02), 2.0, 0.01), LawJudgement::supported);
  EXPECT_EQ(judge_exponent(law(2.005, 2.004, 2.006), 2.0, 0.01), LawJudgement::supported);
  EXPECT_EQ(judge_exponent(law(2.1, 1.9, 2.25), 2.0, 0.01), LawJudgement::supported);
  EXPECT_EQ(judge_exponent(law(2.1, 2.05, 2.15), 2.0, 0.01), LawJudgement::refuted);
  // The damped impact: nearly anything is in its interval.
  EXPECT_EQ(judge_exponent(law(4.33, -1.4, 10.06), 2.0, 0.01), LawJudgement::open);
  EXPECT_EQ(judge_exponent(law(2.0, -1.4, 5.4), 2.0, 0.01), LawJudgement::open);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(judge_exponent(law(nan, nan, nan), 2.0, 0.01), LawJudgement::refuted);
}

}  // namespace
}  // namespace fw::analysis
