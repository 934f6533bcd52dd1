#include "analysis/fit/efficiency.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace fw::analysis {
namespace {

TEST(ParetoFront, AgreesWithTheDefinitionOnRandomPoints) {
  std::mt19937_64 random(20111208);
  std::uniform_int_distribution<int> draw(1, 12);  // few values, so that many points are equal in something
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<double> costs, errors;
    for (int k = 0; k < 25; ++k) {
      costs.push_back(draw(random));
      errors.push_back(draw(random));
    }
    const std::vector<char> front = pareto_front(costs, errors);
    for (std::size_t i = 0; i < costs.size(); ++i) {
      bool dominated = false;
      for (std::size_t j = 0; j < costs.size(); ++j) {
        dominated = dominated || (costs[j] <= costs[i] && errors[j] <= errors[i] &&
                                  (costs[j] < costs[i] || errors[j] < errors[i]));
      }
      EXPECT_EQ(front[i] != 0, !dominated) << costs[i] << " " << errors[i];
    }
  }
}

TEST(ParetoFront, LeavesOutPointsThatAreNoNumbers) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> costs{1.0, nan, 0.0, 2.0, 3.0}, errors{nan, 1e-9, 1e-9, 1e-3, 1e-2};
  EXPECT_EQ(pareto_front(costs, errors), (std::vector<char>{0, 0, 0, 1, 0}));
}

TEST(CostAtError, InterpolatesAPowerLawExactly) {
  std::vector<double> costs, errors;
  for (double cost = 10.0; cost < 1e4; cost *= 3.0) {
    costs.push_back(cost);
    errors.push_back(std::pow(cost, -4.0));
  }
  EXPECT_NEAR(cost_at_error(costs, errors, 1e-8), 100.0, 1e-9);
  EXPECT_DOUBLE_EQ(cost_at_error(costs, errors, 1.0), 10.0) << "every run is accurate enough";
  EXPECT_TRUE(std::isnan(cost_at_error(costs, errors, 1e-30))) << "none is";
}

TEST(CostAtError, TakesTheCheapestWayOfALadderThatFallsTwice) {
  const std::vector<double> costs{1.0, 10.0, 100.0, 1000.0}, errors{1.0, 1e-4, 1.0, 1e-4};
  EXPECT_NEAR(cost_at_error(costs, errors, 1e-2), std::sqrt(10.0), 1e-12);
}

}  // namespace
}  // namespace fw::analysis
