#include "analysis/fit/binned_series.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace fw::analysis {
namespace {

TEST(BinnedSeries, KeepsLeastLargestAndMeanOfEveryBin) {
  BinnedSeries series(10, 5);
  for (int k = 0; k < 10; ++k) series.add(k, k % 2 == 0 ? k : -k);
  EXPECT_EQ(series.least(), (std::vector<double>{-1, -3, -5, -7, -9}));
  EXPECT_EQ(series.largest(), (std::vector<double>{0, 2, 4, 6, 8}));
  EXPECT_EQ(series.means(), (std::vector<double>{-0.5, -0.5, -0.5, -0.5, -0.5}));
  EXPECT_EQ(series.times(), (std::vector<double>{0.5, 2.5, 4.5, 6.5, 8.5}));
  EXPECT_EQ(series.largest_magnitude(), 9.0);
}

TEST(BinnedSeries, LeavesBinsBlankThatNothingHasReached) {
  BinnedSeries series(100, 4);
  for (int k = 0; k < 30; ++k) series.add(k, 1.0);
  EXPECT_EQ(series.means()[0], 1.0);
  EXPECT_EQ(series.means()[1], 1.0);
  EXPECT_TRUE(std::isnan(series.means()[2]));
  EXPECT_TRUE(std::isnan(series.least()[3]));
}

TEST(BinnedSeries, HasSlopeAndCorrelationOfAllValues) {
  BinnedSeries series(1000, 7);
  for (int k = 0; k < 1000; ++k) series.add(0.1 * k, 3.0 - 0.25 * (0.1 * k));
  EXPECT_NEAR(series.slope(), -0.25, 1e-13);
  EXPECT_NEAR(series.correlation(), -1.0, 1e-13);
}

TEST(Drift, SeparatesATrendFromAnOscillation) {
  BinnedSeries series(100'000, 200);
  for (int k = 0; k < 100'000; ++k) series.add(0.01 * k, 1e-3 * (0.01 * k) + 0.5 * std::sin(0.37 * k));
  const Drift drift = fit_drift(series);
  ASSERT_TRUE(drift.valid);
  EXPECT_LT(drift.slope_low, 1e-3);
  EXPECT_GT(drift.slope_high, 1e-3);
  EXPECT_GT(drift.slope_low, 0.99e-3);
  EXPECT_NEAR(drift.oscillation, 0.5 + 0.5 * 1e-3 * 50.0, 4e-3);  // samples miss the crests
  EXPECT_NEAR(drift.significance(), 1e-3 * 950.0 / drift.oscillation, 0.01);
}

TEST(Drift, KnowsBatchesThatAreShortAgainstTheMotion) {
  const auto drift_of = [](auto value) {
    BinnedSeries series(4000, 200);
    for (int k = 0; k < 4000; ++k) series.add(0.01 * k, value(0.01 * k));
    return fit_drift(series);
  };
  std::mt19937_64 random(20261128);
  std::normal_distribution<double> noise;
  const auto fast = [&](double) { return noise(random); };
  EXPECT_TRUE(drift_of([&](double t) { return 1e-2 * t + fast(t); }).has_long_batches());
  // A trend alone oscillates in no batch, and the means over three slow waves follow these.
  EXPECT_FALSE(drift_of([](double t) { return 1e-2 * t; }).has_long_batches());
  const Drift slow = drift_of([&](double t) { return 1e-2 * t + fast(t) + std::sin(0.5 * t); });
  EXPECT_FALSE(slow.has_long_batches());
  EXPECT_LT(slow.independence, 1.2);
}

TEST(Drift, CoversZeroForNoiseWithoutTrendAsOftenAsItSays) {
  std::mt19937_64 random(20261122);
  std::normal_distribution<double> noise;
  int covered = 0;
  for (int trial = 0; trial < 400; ++trial) {
    BinnedSeries series(400, 40);
    for (int k = 0; k < 400; ++k) series.add(k, noise(random));
    const Drift drift = fit_drift(series);
    covered += drift.slope_low <= 0.0 && drift.slope_high >= 0.0 ? 1 : 0;
  }
  // 95 % of 400 are 380, with a standard deviation of 4.4.
  EXPECT_GE(covered, 362);
  EXPECT_LE(covered, 396);
}

}  // namespace
}  // namespace fw::analysis
