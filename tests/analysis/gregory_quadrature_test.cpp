#include "analysis/fit/gregory_quadrature.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fw::analysis {
namespace {

double integral_of(int steps, double length, auto f) {
  GregoryQuadrature quadrature;
  for (int n = 0; n <= steps; ++n) quadrature.add(f(length * n / steps));
  return quadrature.integral(length / steps);
}

TEST(GregoryQuadrature, IsExactForPolynomialsOfDegreeSevenAndNotOfNine) {
  for (int degree = 0; degree <= 7; ++degree) {
    const double value = integral_of(12, 1.3, [&](double x) { return std::pow(x, degree); });
    EXPECT_NEAR(value, std::pow(1.3, degree + 1) / (degree + 1), 1e-14) << degree;
  }
  const double ninth = integral_of(12, 1.3, [](double x) { return std::pow(x, 9); });
  EXPECT_GT(std::abs(ninth - std::pow(1.3, 10) / 10.0), 1e-9);
}

TEST(GregoryQuadrature, HasOrderEight) {
  const auto error = [](int steps) {
    return std::abs(integral_of(steps, 1.0, [](double x) { return std::exp(2.0 * x); }) -
                    0.5 * (std::exp(2.0) - 1.0));
  };
  EXPECT_NEAR(std::log2(error(16) / error(32)), 8.0, 0.6);
}

TEST(GregoryQuadrature, IsTheTrapezoidalRuleForTwoValuesAndZeroForOne) {
  EXPECT_EQ(integral_of(1, 2.0, [](double x) { return 3.0 * x; }), 6.0);
  GregoryQuadrature quadrature;
  quadrature.add(5.0);
  EXPECT_EQ(quadrature.integral(0.1), 0.0);
}

}  // namespace
}  // namespace fw::analysis
