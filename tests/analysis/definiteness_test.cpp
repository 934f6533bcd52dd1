#include <gtest/gtest.h>

#include <cmath>

#include "analysis/theory/definiteness.hpp"
#include "analysis/theory/numerical_jacobian.hpp"
#include "problems/oscillators.hpp"
#include "problems/stiff_equations.hpp"

namespace fw::analysis {
namespace {

/// Two masses on one compressed spring across its axis: K = κ [[1, −1], [−1, 1]] with κ > 0.
Matrix buckling(double kappa) {
  Matrix K(2, 2);
  K << kappa, -kappa, -kappa, kappa;
  return K;
}

TEST(FastestGrowthRate, OfTwoMassesIsThatOfTheirReducedMass) {
  Vector mass(2);
  mass << 2.0, 3.0;
  const double reduced = 2.0 * 3.0 / 5.0;
  EXPECT_NEAR(fastest_growth_rate(buckling(7.0), Matrix::Zero(2, 2), mass), std::sqrt(7.0 / reduced), 1e-13);
  EXPECT_EQ(fastest_growth_rate(buckling(-7.0), Matrix::Zero(2, 2), mass), 0.0);
}

TEST(FastestGrowthRate, WithDampingIsTheRootOfTheQuadratic) {
  const Vector mass = Vector::Constant(1, 2.0);
  const Matrix K = Matrix::Constant(1, 1, 8.0), D = Matrix::Constant(1, 1, -6.0);
  // 2 μ² + 6 μ − 8 = 0.
  EXPECT_NEAR(fastest_growth_rate(K, D, mass), 1.0, 1e-12);
}

TEST(FastestGrowthRate, IsWhereTheStepMatrixLosesItsDefiniteness) {
  const Vector mass = Vector::Constant(2, 1.5);
  const Matrix K = buckling(3.0), D = -0.4 * Matrix::Identity(2, 2);
  const double limit = 1.0 / fastest_growth_rate(K, D, mass);
  const auto A = [&](double h) { return Matrix(Matrix(mass.asDiagonal()) - h * D - h * h * K); };
  EXPECT_TRUE(is_positive_definite(A(limit * (1.0 - 1e-9))));
  EXPECT_FALSE(is_positive_definite(A(limit * (1.0 + 1e-9))));
  EXPECT_GT(smallest_eigenvalue(A(limit * (1.0 - 1e-9))), 0.0);
  EXPECT_LT(smallest_eigenvalue(A(limit * (1.0 + 1e-9))), 0.0);
}

TEST(NumericalJacobian, OfComplexStepsIsTheAnalyticOneToRounding) {
  const Problem problem = problems::van_der_pol();
  const Vector& y = problem.ivp.y0;
  const Matrix exact = analytic_jacobian(*problem.ivp.system, 0.0, y);
  EXPECT_LE((complex_step_jacobian(*problem.ivp.system, 0.0, y) - exact).cwiseAbs().maxCoeff(),
            1e-15 * exact.cwiseAbs().maxCoeff());
}

TEST(NumericalJacobian, ByDifferencesHasItsTruncationError) {
  const Problem problem = problems::van_der_pol();
  Vector y(2);
  y << 0.7, -0.3;
  const OdeSystem& system = *problem.ivp.system;
  const Matrix exact = analytic_jacobian(system, 0.0, y);
  const auto error = [&](double h, Difference difference) {
    return (difference_jacobian(system, 0.0, y, h, difference) - exact).cwiseAbs().maxCoeff();
  };
  EXPECT_NEAR(error(1e-3, Difference::forward) / error(1e-4, Difference::forward), 10.0, 0.1);
  // The right-hand side is quadratic in each component.
  EXPECT_LE(error(1e-3, Difference::central), 1e-9 * exact.cwiseAbs().maxCoeff());
}

}  // namespace
}  // namespace fw::analysis
