#include "analysis/fit/order_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace fw::analysis {
namespace {

std::vector<double> geometric_steps(double first, double ratio, int count) {
  std::vector<double> steps;
  for (int k = 0; k < count; ++k) steps.push_back(first / std::pow(ratio, k));
  return steps;
}

TEST(FitOrder, RecoversAnExactPowerLaw) {
  const auto steps = geometric_steps(0.1, 1.5, 8);
  std::vector<double> errors;
  for (double h : steps) errors.push_back(3.0 * std::pow(h, 3.0));
  const OrderFit fit = fit_order(steps, errors, 0.0);
  ASSERT_TRUE(fit.valid) << fit.reason;
  EXPECT_NEAR(fit.order, 3.0, 1e-12);
  EXPECT_NEAR(fit.correlation, 1.0, 1e-12);
  EXPECT_EQ(fit.points, 8);
}

TEST(FitOrder, LeavesThePreAsymptoticRangeOut) {
  const auto steps = geometric_steps(1.0, 2.0, 12);
  std::vector<double> errors;
  for (double h : steps) errors.push_back(h * h / (1.0 + 30.0 * h * h));  // flat, then order 2
  const OrderFit fit = fit_order(steps, errors, 0.0);
  ASSERT_TRUE(fit.valid) << fit.reason;
  EXPECT_NEAR(fit.order, 2.0, 0.03);
  EXPECT_FALSE(fit.used[0]);
  EXPECT_FALSE(fit.used[1]);
  EXPECT_TRUE(fit.used[11]);
}

TEST(FitOrder, LeavesTheFloorOutWhereALeastSquaresLineThroughAllPointsIsWrong) {
  const auto steps = geometric_steps(0.3, 1.6, 16);
  std::vector<double> errors;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> noise(0.3, 1.0);
  for (double h : steps) errors.push_back(std::pow(h, 6.0) + 1e-13 * noise(random));
  const OrderFit fit = fit_order(steps, errors, 1e-11);
  ASSERT_TRUE(fit.valid) << fit.reason;
  EXPECT_NEAR(fit.order, 6.0, 0.02);
  EXPECT_FALSE(fit.used.back());
  // The naive fit of all points, the mistake that this rule exists for.
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const double x = std::log(steps[k]), y = std::log(errors[k]);
    sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  const double count = static_cast<double>(steps.size());
  EXPECT_LT((count * sxy - sx * sy) / (count * sxx - sx * sx), 5.5);
}

TEST(FitOrder, FindsTheFloorByItselfWhenNoneIsGiven) {
  const auto steps = geometric_steps(0.3, 1.6, 16);
  std::vector<double> errors;
  for (double h : steps) errors.push_back(std::pow(h, 4.0) + 1e-9);
  const OrderFit fit = fit_order(steps, errors, 0.0);
  ASSERT_TRUE(fit.valid) << fit.reason;
  EXPECT_NEAR(fit.order, 4.0, 0.05);
  EXPECT_FALSE(fit.used.back());
}

TEST(FitOrder, ClaimsNothingForAnErrorThatDoesNotFall) {
  const auto steps = geometric_steps(0.3, 1.6, 16);
  std::vector<double> errors;
  for (double h : steps) errors.push_back(0.1 + 0.01 * h);
  EXPECT_FALSE(fit_order(steps, errors, 0.0).valid);
}

TEST(FitOrder, IntervalCoversTheTrueOrderAboutNinetyFivePercentOfTheTime) {
  std::mt19937_64 random(20110);
  std::normal_distribution<double> noise(0.0, 0.01);
  const auto steps = geometric_steps(0.1, 1.5, 8);
  int covered = 0, valid = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<double> errors;
    for (double h : steps) errors.push_back(h * h * std::exp(noise(random)));
    const OrderFit fit = fit_order(steps, errors, 0.0, 10.0);
    ASSERT_TRUE(fit.valid);
    ++valid;
    covered += fit.order_low <= 2.0 && 2.0 <= fit.order_high;
  }
  EXPECT_NEAR(static_cast<double>(covered) / valid, 0.95, 0.02);
}

TEST(FitOrder, RefusesTooFewPointsAndSaysSo) {
  const std::vector<double> steps = {0.1, 0.05, 0.025};
  const std::vector<double> errors = {1e-2, 2.5e-3, 6e-4};
  const OrderFit fit = fit_order(steps, errors, 0.0);
  EXPECT_FALSE(fit.valid);
  EXPECT_NE(fit.reason.find("3 of 3"), std::string::npos) << fit.reason;
}

TEST(FitOrder, PassesOverBlownUpCoarseRuns) {
  const auto steps = geometric_steps(1.0, 2.0, 10);
  std::vector<double> errors;
  for (double h : steps) errors.push_back(h > 0.2 ? std::numeric_limits<double>::infinity() : h);
  const OrderFit fit = fit_order(steps, errors, 0.0);
  ASSERT_TRUE(fit.valid) << fit.reason;
  EXPECT_NEAR(fit.order, 1.0, 1e-12);
  EXPECT_EQ(fit.points, 7);
}

}  // namespace
}  // namespace fw::analysis
