#include "linalg/newton.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "linalg/simplified_newton.hpp"

namespace fw::linalg {
namespace {

/// One equation g(u) = 0, which counts what is asked of it.
class Equation final : public NewtonProblem {
 public:
  Equation(std::function<double(double)> g, std::function<double(double)> slope)
      : g_(std::move(g)), slope_(std::move(slope)), matrix_(1, 1) {
    matrix_.insert(0, 0) = 1.0;
    matrix_.makeCompressed();
  }
  void residual(ConstVectorRef u, VectorRef out) override {
    last_ = u[0];
    out[0] = g_(u[0]);
  }
  const SparseMatrix& matrix(ConstVectorRef u) override {
    ++matrices_;
    matrix_.coeffRef(0, 0) = slope_(u[0]);
    return matrix_;
  }
  /// Where the residual was evaluated last.
  double last() const { return last_; }
  int matrices() const { return matrices_; }

 private:
  std::function<double(double)> g_, slope_;
  SparseMatrix matrix_;
  double last_ = std::numeric_limits<double>::quiet_NaN();
  int matrices_ = 0;
};

/// u² = 2, u² = −1 (no root), atan u = 0 (diverges from 3 without damping).
Equation root_of_two() {
  return {[](double u) { return u * u - 2.0; }, [](double u) { return 2.0 * u; }};
}
Equation no_root() {
  return {[](double u) { return u * u + 1.0; }, [](double u) { return 2.0 * u; }};
}
Equation arc_tangent() {
  return {[](double u) { return std::atan(u); }, [](double u) { return 1.0 / (1.0 + u * u); }};
}

struct Outcome {
  Status status;
  double u = 0.0;
  Work work{};
};

Outcome damped(Equation& equation, double start) {
  Newton newton(1);
  Vector u = Vector::Constant(1, start);
  Outcome run;
  run.status = newton.solve(equation, u, 1.0, run.work);
  run.u = u[0];
  return run;
}

TEST(Newton, ConvergesQuadraticallyAndEvaluatesLastAtItsResult) {
  Equation equation = root_of_two();
  const Outcome run = damped(equation, 1.0);
  EXPECT_TRUE(run.status.ok()) << run.status.describe();
  EXPECT_NEAR(run.u, std::sqrt(2.0), 4e-16);
  // Errors 0.4, 0.09, 2e-3, 2e-6, 2e-12, then rounding.
  EXPECT_GE(run.work.newton_iterations, 5u);
  EXPECT_LE(run.work.newton_iterations, 6u);
  EXPECT_EQ(run.work.newton_iterations, static_cast<std::uint64_t>(equation.matrices())) << "a matrix each";
  EXPECT_EQ(equation.last(), run.u);
}

TEST(Newton, TakesNoStepFromARoot) {
  Equation equation = arc_tangent();
  const Outcome run = damped(equation, 0.0);
  EXPECT_TRUE(run.status.ok());
  EXPECT_EQ(run.u, 0.0);
  EXPECT_EQ(run.work.newton_iterations, 0u);
  EXPECT_EQ(equation.matrices(), 0);
}

TEST(Newton, HalvesCorrectionsThatWouldLeadAway) {
  ASSERT_GT(std::abs(3.0 - std::atan(3.0) * 10.0), 3.0) << "a full step leads away";
  Equation equation = arc_tangent();
  const Outcome run = damped(equation, 3.0);
  EXPECT_TRUE(run.status.ok()) << run.status.describe();
  EXPECT_NEAR(run.u, 0.0, 1e-12);
}

TEST(Newton, FailsWhereThereIsNoRoot) {
  Equation equation = no_root();
  const Outcome run = damped(equation, 0.7);
  EXPECT_EQ(run.status.code, StatusCode::newton_failed);
  EXPECT_EQ(run.status.message.find("Newton's iteration did not converge in 50 iterations (residual "), 0u)
      << run.status.message;
  EXPECT_EQ(run.work.newton_iterations, 50u);
}

TEST(Newton, FailsWithTheLinearSolversReasonWhereTheDerivativeVanishes) {
  Equation equation = no_root();
  const Outcome run = damped(equation, 0.0);
  EXPECT_EQ(run.status.code, StatusCode::matrix_singular) << run.status.describe();
  EXPECT_EQ(run.u, 0.0) << "the guess is kept";
}

TEST(Newton, FailsWhereTheResidualIsNotFinite) {
  Equation equation([](double u) { return std::log(u); }, [](double u) { return 1.0 / u; });
  const Outcome run = damped(equation, -1.0);
  EXPECT_EQ(run.status.code, StatusCode::non_finite);
  EXPECT_EQ(run.work.newton_iterations, 0u);
}

/// Two solves with one matrix: of a first equation and of another one that is a little different.
class Simplified : public testing::Test {
 protected:
  Outcome solve(Equation& equation, double start, double parameter) {
    Vector u = Vector::Constant(1, start);
    Outcome run;
    run.status = newton_.solve(equation, u, parameter, 1.0, 0.0, run.work);
    run.u = u[0];
    return run;
  }
  SimplifiedNewton newton_{1, {}};
};

TEST_F(Simplified, KeepsItsMatrixOverSolvesWithTheSameParameter) {
  Equation equation([](double u) { return u + 0.01 * u * u - 1.0; }, [](double u) { return 1.0 + 0.02 * u; });
  const double root = 2.0 / (1.0 + std::sqrt(1.04));  // without cancellation
  for (const double start : {1.0, 0.99, 1.01}) {
    const Outcome run = solve(equation, start, 0.5);
    EXPECT_TRUE(run.status.ok()) << run.status.describe();
    EXPECT_NEAR(run.u, root, 4e-16);
    EXPECT_EQ(equation.last(), run.u);
  }
  EXPECT_EQ(equation.matrices(), 1);
  EXPECT_TRUE(solve(equation, 1.0, 0.25).status.ok());
  EXPECT_EQ(equation.matrices(), 2) << "another step has another matrix";
  newton_.forget_matrix();
  EXPECT_TRUE(solve(equation, 1.0, 0.25).status.ok());
  EXPECT_EQ(equation.matrices(), 3) << "it was told to forget";
}

TEST_F(Simplified, TakesANewMatrixWhereTheOldOneLeadsAway) {
  Equation steep([](double u) { return u - 1.0; }, [](double) { return 1.0; });
  ASSERT_TRUE(solve(steep, 0.5, 1.0).status.ok());
  // u ↦ u − (4 u − 4) multiplies the error by −3 with the matrix of `steep`.
  Equation steeper([](double u) { return 4.0 * u - 4.0; }, [](double) { return 4.0; });
  const Outcome run = solve(steeper, 0.5, 1.0);
  EXPECT_TRUE(run.status.ok()) << run.status.describe();
  EXPECT_EQ(run.u, 1.0);
  EXPECT_EQ(steeper.matrices(), 1);
}

TEST_F(Simplified, HandsOverToTheDampedIterationWhereANewMatrixLeadsAwayToo) {
  Equation equation = arc_tangent();
  const Outcome run = solve(equation, 3.0, 1.0);
  EXPECT_TRUE(run.status.ok()) << run.status.describe();
  EXPECT_NEAR(run.u, 0.0, 1e-12);
  EXPECT_GT(equation.matrices(), 2);
}

TEST_F(Simplified, FailsWhereThereIsNoRoot) {
  Equation equation = no_root();
  EXPECT_EQ(solve(equation, 0.7, 1.0).status.code, StatusCode::newton_failed);
  EXPECT_EQ(solve(equation, 0.0, 2.0).status.code, StatusCode::matrix_singular);
}

}  // namespace
}  // namespace fw::linalg
