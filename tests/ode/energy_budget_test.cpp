#include "ode/energy_budget.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fw {
namespace {

/// Of a fall under explicit Euler from rest with steps of 1, mass and gravity 1, after `steps` of them.
EnergyBudget falling(int steps) {
  EnergyBudget budget;
  double height = 0.0, speed = 0.0;
  for (int n = 0; n <= steps; ++n) {
    budget.add(0.5 * speed * speed, 0.0, height);
    height -= speed;
    speed += 1.0;
  }
  return budget;
}

TEST(EnergyBudget, TakesNoFirstStepsOfAFallForAnExplosion) {
  for (int steps = 1; steps < 100; ++steps) EXPECT_FALSE(falling(steps).has_exploded()) << steps;
}

TEST(EnergyBudget, SeesAnExplosionInTwoSteps) {
  for (const double factor : {1e3, 1e10}) {
    for (int steps = 2; steps < 15; ++steps) {
      EnergyBudget budget;
      for (int n = 0; n <= steps; ++n) budget.add(std::pow(factor, n), 1.0, 0.0);
      EXPECT_TRUE(budget.has_exploded()) << factor << " per step, " << steps;
    }
  }
}

TEST(EnergyBudget, HasToGrowAHundredfold) {
  EnergyBudget budget;
  for (const double kinetic : {1.0, 30.0, 90.0}) budget.add(kinetic, 0.0, 0.0);
  EXPECT_FALSE(budget.has_exploded());
  budget.add(110.0, 0.0, 0.0);
  EXPECT_TRUE(budget.has_exploded());
}

}  // namespace
}  // namespace fw
