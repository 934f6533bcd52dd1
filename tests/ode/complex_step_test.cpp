#include "ode/complex_step.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace fw {
namespace {

/// f = (y₀ y₁, sin y₁ + y₂³) of three variables.
void evaluate(const std::vector<Complex>& y, std::vector<Complex>& f) {
  f[0] = y[0] * y[1];
  f[1] = std::sin(y[1]) + y[2] * y[2] * y[2];
}

Matrix exact(const Vector& y) {
  Matrix J(2, 3);
  J << y[1], y[0], 0.0, 0.0, std::cos(y[1]), 3.0 * y[2] * y[2];
  return J;
}

TEST(ComplexStep, GivesDerivativesToRounding) {
  const Vector y = Eigen::Vector3d(0.7, -1.3, 2.1);
  Matrix J = Matrix::Zero(2, 3);
  std::vector<std::pair<Index, Index>> order;
  complex_step_jacobian(y, 2, 0, 3, evaluate, [&](Index i, Index j, double value) {
    J(i, j) = value;
    order.emplace_back(i, j);
  });
  EXPECT_LT((J - exact(y)).cwiseAbs().maxCoeff(), 4e-15);
  EXPECT_EQ(order, (std::vector<std::pair<Index, Index>>{{0, 0}, {1, 0}, {0, 1}, {1, 1}, {0, 2}, {1, 2}}));
}

TEST(ComplexStep, MakesTheColumnsThatAreAskedFor) {
  const Vector y = Eigen::Vector3d(0.7, -1.3, 2.1);
  int evaluations = 0;
  Matrix J = Matrix::Constant(2, 3, 17.0);
  const auto counted = [&](const std::vector<Complex>& at, std::vector<Complex>& f) {
    ++evaluations;
    evaluate(at, f);
  };
  complex_step_jacobian(y, 2, 1, 2, counted, [&](Index i, Index j, double value) { J(i, j) = value; });
  EXPECT_EQ(evaluations, 1);
  EXPECT_LT((J.col(1) - exact(y).col(1)).norm(), 1e-15);
  EXPECT_EQ(J(0, 0), 17.0);
  EXPECT_EQ(J(1, 2), 17.0);
}

TEST(ComplexStep, MultipliesAsTheJacobian) {
  const Vector y = Eigen::Vector3d(0.7, -1.3, 2.1), w = Eigen::Vector3d(-2.0, 0.5, 3.0);
  Vector product(2);
  complex_step_product(y, w, evaluate, product);
  const Matrix J = exact(y);
  for (Index i = 0; i < 2; ++i) {
    EXPECT_NEAR(product[i], J(i, 0) * w[0] + J(i, 1) * w[1] + J(i, 2) * w[2], 1e-14);
  }
}

}  // namespace
}  // namespace fw
