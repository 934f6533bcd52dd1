#include "linalg/linear_solver.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "core/error.hpp"

namespace fw::linalg {
namespace {

std::vector<LinearSolverKind> all_kinds() {
  std::vector<LinearSolverKind> kinds;
  for (const LinearSolverInfo& info : linear_solvers()) kinds.push_back(info.kind);
  return kinds;
}

/// A sparse symmetric matrix with the given shift on the diagonal: positive definite for a large shift.
SparseMatrix random_symmetric(Index n, double shift, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  Matrix dense = Matrix::Zero(n, n);
  for (Index j = 0; j < n; ++j) {
    for (Index i = 0; i < j; ++i) {
      if (uniform(random) < 0.2) dense(i, j) = dense(j, i) = normal(random);
    }
    dense(j, j) = shift;
  }
  SparseMatrix matrix = dense.sparseView();
  matrix.makeCompressed();
  return matrix;
}

Vector random_vector(Index n, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Vector v(n);
  for (Index i = 0; i < n; ++i) v[i] = normal(random);
  return v;
}

TEST(LinearSolvers, AgreeWithADenseSolveAndReportTheTrueResidual) {
  for (Index n : {30, 31}) {  // with and without 3×3 blocks
    const SparseMatrix A = random_symmetric(n, 12.0, 3);
    const Vector b = random_vector(n, 4);
    const Vector expected = Matrix(A).lu().solve(b);
    for (LinearSolverKind kind : all_kinds()) {
      Work work;
      const auto solver = make_linear_solver({.kind = kind, .relative_tolerance = 1e-12});
      ASSERT_TRUE(solver->factorise(A, work).ok());
      Vector x = Vector::Zero(n);
      const LinearSolve solve = solver->solve(b, x, work);
      ASSERT_TRUE(solve.status.ok()) << solve.status.describe();
      EXPECT_LT((x - expected).norm(), 1e-10 * expected.norm());
      EXPECT_NEAR(solve.relative_residual, (b - A * x).norm() / b.norm(), 1e-14);
      EXPECT_EQ(work.linear_solves, 1u);
    }
  }
}

TEST(LinearSolvers, TakeNewValuesInTheSamePattern) {
  const Index n = 24;
  const Vector b = random_vector(n, 5);
  for (LinearSolverKind kind : all_kinds()) {
    Work work;
    const auto solver = make_linear_solver({.kind = kind, .relative_tolerance = 1e-12});
    for (double factor : {1.0, 3.0, 1e-3}) {
      SparseMatrix A = random_symmetric(n, 12.0, 6);
      A.coeffs() *= factor;
      ASSERT_TRUE(solver->factorise(A, work).ok());
      Vector x = Vector::Zero(n);
      ASSERT_TRUE(solver->solve(b, x, work).status.ok());
      EXPECT_LT((A * x - b).norm(), 1e-10 * b.norm());
    }
  }
}

TEST(ConjugateGradient, ReportsAnIndefiniteMatrix) {
  SparseMatrix A = random_symmetric(30, 1.0, 8);  // off-diagonal entries outweigh the diagonal
  ASSERT_LT(Eigen::SelfAdjointEigenSolver<Matrix>(Matrix(A)).eigenvalues().minCoeff(), -0.1);
  Work work;
  const auto solver = make_linear_solver({.kind = LinearSolverKind::conjugate_gradient});
  Status status = solver->factorise(A, work);
  if (status.ok()) {
    Vector x = Vector::Zero(30);
    status = solver->solve(random_vector(30, 9), x, work).status;
  }
  EXPECT_EQ(status.code, StatusCode::matrix_indefinite) << status.describe();
}

TEST(ConjugateGradient, SaysWhenItsIterationsDoNotSuffice) {
  const SparseMatrix A = random_symmetric(90, 8.0, 10);
  Work work;
  const auto solver = make_linear_solver(
      {.kind = LinearSolverKind::conjugate_gradient, .relative_tolerance = 1e-14, .max_iterations = 2});
  ASSERT_TRUE(solver->factorise(A, work).ok());
  Vector x = Vector::Zero(90);
  EXPECT_EQ(solver->solve(random_vector(90, 11), x, work).status.code, StatusCode::linear_solver_failed);
}

TEST(ConjugateGradient, SolvesAZeroRightHandSideByZero) {
  const SparseMatrix A = random_symmetric(30, 12.0, 12);
  Work work;
  const auto solver = make_linear_solver({.kind = LinearSolverKind::conjugate_gradient});
  ASSERT_TRUE(solver->factorise(A, work).ok());
  Vector x = random_vector(30, 13);
  ASSERT_TRUE(solver->solve(Vector::Zero(30), x, work).status.ok());
  EXPECT_EQ(x.norm(), 0.0);
}

TEST(LinearSolvers, KeepWhatTheyHaveWhenTheMatrixIsReplaced) {
  const Index n = 30;
  const SparseMatrix first = random_symmetric(n, 12.0, 6);
  SparseMatrix second = first;
  second.coeffs() *= 1.1;
  for (Index j = 0; j < n; ++j) second.coeffRef(j, j) += 0.1 * static_cast<double>(j);
  const Vector b = random_vector(n, 5);
  for (LinearSolverKind kind : all_kinds()) {
    SCOPED_TRACE(find_linear_solver(kind).name);
    Work work;
    const auto solver = make_linear_solver({.kind = kind, .relative_tolerance = 1e-12});
    ASSERT_TRUE(solver->factorise(first, work).ok());
    ASSERT_TRUE(solver->replace_matrix(second, work).ok());
    EXPECT_EQ(work.factorisations, find_linear_solver(kind).is_iterative ? 1u : 2u);
    Vector x = Vector::Zero(n);
    ASSERT_TRUE(solver->solve(b, x, work).status.ok());
    EXPECT_LT((second * x - b).norm(), 1e-10 * b.norm());
  }
}

TEST(LinearSolvers, ReportAnIndefiniteMatrixWhereTheyNeedADefiniteOne) {
  const SparseMatrix A = random_symmetric(30, 1.0, 8);
  for (const LinearSolverInfo& info : linear_solvers()) {
    // Eigen's conjugate gradients do not look at the curvature: their true residual decides.
    if (!info.needs_definite || info.kind == LinearSolverKind::eigen_conjugate_gradient) continue;
    SCOPED_TRACE(info.name);
    Work work;
    const auto solver = make_linear_solver({.kind = info.kind});
    Status status = solver->factorise(A, work);
    if (status.ok()) {
      Vector x = Vector::Zero(30);
      status = solver->solve(random_vector(30, 9), x, work).status;
    }
    EXPECT_EQ(status.code, StatusCode::matrix_indefinite) << status.describe();
  }
}

TEST(LinearSolvers, OfUnsymmetricMatricesReportASingularOne) {
  SparseMatrix A = random_symmetric(30, 12.0, 14);
  for (SparseMatrix::InnerIterator entry(A, 7); entry; ++entry) entry.valueRef() = 0.0;
  for (const char* name : {"lu", "eigen_lu"}) {
    SCOPED_TRACE(name);
    Work work;
    const auto solver = make_linear_solver({.kind = find_linear_solver(name).kind});
    EXPECT_EQ(solver->factorise(A, work).code, StatusCode::matrix_singular);
  }
}

TEST(LinearSolvers, OfUnsymmetricMatricesSolveIndefiniteOnes) {
  SparseMatrix A = random_symmetric(30, 1.0, 8);
  A.coeffs().head(20) *= 1.7;
  const Vector b = random_vector(30, 15);
  for (const char* name : {"lu", "eigen_lu"}) {
    SCOPED_TRACE(name);
    Work work;
    const auto solver = make_linear_solver({.kind = find_linear_solver(name).kind});
    ASSERT_TRUE(solver->factorise(A, work).ok());
    Vector x(30);
    ASSERT_TRUE(solver->solve(b, x, work).status.ok());
    EXPECT_LT((A * x - b).norm(), 1e-10 * b.norm());
  }
}

TEST(SparseLdlt, SolvesASymmetricIndefiniteMatrix) {
  const SparseMatrix A = random_symmetric(30, 1.0, 8);
  const Vector b = random_vector(30, 15);
  Work work;
  const auto solver = make_linear_solver({.kind = LinearSolverKind::sparse_ldlt});
  ASSERT_TRUE(solver->factorise(A, work).ok());
  Vector x(30);
  const LinearSolve solve = solver->solve(b, x, work);
  ASSERT_TRUE(solve.status.ok()) << solve.status.describe();
  EXPECT_LT((A * x - b).norm(), 1e-8 * b.norm());
}

TEST(LinearSolvers, AreFoundByNameOrSayWhichThereAre) {
  EXPECT_EQ(find_linear_solver("cholmod").kind, LinearSolverKind::cholmod);
  try {
    find_linear_solver("colmod");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(
        error.what(),
        "unknown linear solver \"colmod\", expected cg, cholesky, ldlt, lu, eigen_cg, eigen_lu, cholmod or "
        "petsc; did you mean \"cholmod\"?");
  }
}

TEST(LinearSolvers, ReportARightHandSideThatIsNotFinite) {
  const SparseMatrix A = random_symmetric(30, 12.0, 12);
  Vector b = random_vector(30, 13);
  b[4] = std::numeric_limits<double>::quiet_NaN();
  for (LinearSolverKind kind : all_kinds()) {
    Work work;
    const auto solver = make_linear_solver({.kind = kind});
    ASSERT_TRUE(solver->factorise(A, work).ok());
    Vector x = Vector::Zero(30);
    EXPECT_EQ(solver->solve(b, x, work).status.code, StatusCode::non_finite);
  }
}

}  // namespace
}  // namespace fw::linalg
