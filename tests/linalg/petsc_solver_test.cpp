#include "linalg/petsc_solver.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <functional>
#include <thread>

#include "core/error.hpp"
#include "linalg/cloth_step.hpp"
#include "linalg/petsc_call.hpp"
#include "linalg/true_residual.hpp"
#include "sparse/sparse_slots.hpp"

namespace fw::linalg {
namespace {

using testing::HasSubstr;

constexpr PetscMatrixType storages[] = {PetscMatrixType::aij, PetscMatrixType::baij, PetscMatrixType::sbaij};

/// A solve from scratch.
struct PetscOutcome {
  Status set_up;
  LinearSolve solve;
  Vector x;
  Work work;
};

PetscOutcome solve_once(const LinearSolverOptions& options, const SparseMatrix& A, const Vector& b) {
  PetscOutcome outcome;
  const auto solver = make_linear_solver(options);
  outcome.x = Vector::Zero(b.size());
  outcome.set_up = solver->factorise(A, outcome.work);
  if (outcome.set_up.ok()) outcome.solve = solver->solve(b, outcome.x, outcome.work);
  return outcome;
}

class PetscCombinations : public testing::TestWithParam<std::tuple<PetscMatrixType, const char*>> {};

TEST_P(PetscCombinations, AgreeWithKluOnAStepOfACloth) {
  const auto& [storage, text] = GetParam();
  const ClothStep step = cloth_step(12, 2000.0, 0.02);
  const PetscOutcome expected =
      solve_once({.kind = LinearSolverKind::sparse_lu}, step.matrix, step.right_side);
  ASSERT_TRUE(expected.solve.status.ok());
  const PetscOutcome outcome = solve_once(petsc(text, storage), step.matrix, step.right_side);
  ASSERT_TRUE(outcome.set_up.ok()) << text << ": " << outcome.set_up.describe();
  EXPECT_TRUE(outcome.solve.status.ok()) << text << ": " << outcome.solve.status.describe();
  EXPECT_LT(outcome.solve.relative_residual, 1e-9);
  EXPECT_NEAR(outcome.solve.relative_residual,
              (step.right_side - step.matrix * outcome.x).norm() / step.right_side.norm(), 1e-15);
  EXPECT_LT((outcome.x - expected.x).norm(), 1e-8 * expected.x.norm());
  EXPECT_EQ(outcome.work.linear_iterations, outcome.solve.iterations);
}

INSTANTIATE_TEST_SUITE_P(
    EveryStorage, PetscCombinations,
    testing::Combine(testing::ValuesIn(storages),
                     testing::Values("", "-pc_type none", "-pc_type jacobi",
                                     "-pc_type bjacobi -sub_pc_type icc", "-pc_type hypre",
                                     "-ksp_type preonly -pc_type cholesky",
                                     "-ksp_type minres -pc_type jacobi -ksp_rtol 1e-12")));
INSTANTIATE_TEST_SUITE_P(RowsAndBlocks, PetscCombinations,
                         testing::Combine(testing::Values(PetscMatrixType::aij, PetscMatrixType::baij),
                                          testing::Values("-pc_type pbjacobi", "-pc_type sor",
                                                          "-ksp_type preonly -pc_type lu",
                                                          "-ksp_type gmres -pc_type ilu")));
INSTANTIATE_TEST_SUITE_P(
    Rows, PetscCombinations,
    testing::Combine(
        testing::Values(PetscMatrixType::aij),
        testing::Values("-pc_type gamg -pc_gamg_threshold 0.01", "-pc_type gamg -mg_levels_pc_type jacobi",
                        "-ksp_type preonly -pc_type lu -pc_factor_mat_solver_type klu",
                        "-ksp_type preonly -pc_type cholesky -pc_factor_mat_solver_type cholmod",
                        "-ksp_type preonly -pc_type cholesky -pc_factor_mat_solver_type mumps")));

// Each test is a process of its own under ctest: here types are looked up before any object has been made.
TEST(PetscSolver, KnowsTheTypesFromTheStart) {
  EXPECT_NO_THROW(make_linear_solver(petsc("-ksp_type gmres -pc_type gamg")));
  EXPECT_THROW(make_linear_solver(petsc("-ksp_type gmress")), InputError);
}

TEST(PetscSolver, TakesNewValuesInTheSamePatternWithEveryStorage) {
  const ClothStep step = cloth_step(6, 2000.0, 0.02);
  for (const PetscMatrixType storage : storages) {
    for (const char* text : {"", "-pc_type jacobi", "-pc_type bjacobi -sub_pc_type icc", "-pc_type gamg",
                             "-ksp_type preonly -pc_type cholesky"}) {
      const bool is_multigrid = std::string(text).find("gamg") != std::string::npos;
      if (is_multigrid && storage != PetscMatrixType::aij) continue;
      Work work;
      const auto solver = make_linear_solver(petsc(text, storage));
      for (const double shift : {0.0, 3.0, -0.01}) {
        SparseMatrix A = step.matrix;
        sparse::add_to_diagonal(A, shift);
        ASSERT_TRUE(solver->factorise(A, work).ok()) << text;
        Vector x = Vector::Zero(A.cols());
        const LinearSolve fresh = solve_once(petsc(text, storage), A, step.right_side).solve;
        const LinearSolve again = solver->solve(step.right_side, x, work);
        EXPECT_TRUE(again.status.ok()) << text << ": " << again.status.describe();
        EXPECT_LT((step.right_side - A * x).norm(), 1e-9 * step.right_side.norm());
        // Multigrid estimates eigenvalues from random vectors.
        EXPECT_NEAR(static_cast<double>(again.iterations), static_cast<double>(fresh.iterations),
                    is_multigrid ? 2.0 : 0.0)
            << text << ": a preconditioner of old values";
      }
    }
  }
}

TEST(PetscSolver, KeepsThePreconditionerWhenTheMatrixIsReplaced) {
  const ClothStep step = cloth_step(8, 2000.0, 0.02);
  SparseMatrix other = step.matrix;
  other.coeffs() *= 2.0;
  sparse::add_to_diagonal(other, 40.0);
  for (const PetscMatrixType storage : storages) {
    Work work;
    const auto solver = make_linear_solver(petsc("", storage));
    ASSERT_TRUE(solver->factorise(step.matrix, work).ok());
    ASSERT_TRUE(solver->replace_matrix(other, work).ok());
    EXPECT_EQ(work.factorisations, 1u);
    Vector x = Vector::Zero(other.cols());
    const LinearSolve kept = solver->solve(step.right_side, x, work);
    EXPECT_TRUE(kept.status.ok()) << kept.status.describe();
    EXPECT_LT((step.right_side - other * x).norm(), 1e-9 * step.right_side.norm());
    const PetscOutcome fresh = solve_once(petsc("", storage), other, step.right_side);
    EXPECT_GT(kept.iterations, fresh.solve.iterations);
    ASSERT_TRUE(solver->factorise(other, work).ok());
    x.setZero();
    EXPECT_EQ(solver->solve(step.right_side, x, work).iterations, fresh.solve.iterations);
  }
}

TEST(PetscSolver, FactorisesAnewWhenTheMatrixOfADirectSolverIsReplaced) {
  const ClothStep step = cloth_step(6, 2000.0, 0.02);
  SparseMatrix other = step.matrix;
  sparse::add_to_diagonal(other, 1.0);
  Work work;
  const auto solver = make_linear_solver(petsc("-ksp_type preonly -pc_type lu"));
  ASSERT_TRUE(solver->factorise(step.matrix, work).ok());
  ASSERT_TRUE(solver->replace_matrix(other, work).ok());
  Vector x = Vector::Zero(other.cols());
  const LinearSolve solve = solver->solve(step.right_side, x, work);
  EXPECT_TRUE(solve.status.ok()) << solve.status.describe();
  EXPECT_LT(solve.relative_residual, 1e-12);
  EXPECT_EQ(solve.iterations, 0u);
}

TEST(PetscSolver, StartsFromTheInitialGuess) {
  const ClothStep step = cloth_step(8, 2000.0, 0.02);
  Work work;
  const auto solver = make_linear_solver(petsc("-pc_type jacobi"));
  ASSERT_TRUE(solver->factorise(step.matrix, work).ok());
  Vector x = Vector::Zero(step.matrix.cols());
  const std::uint64_t cold = solver->solve(step.right_side, x, work).iterations;
  const Vector solution = x;
  EXPECT_EQ(solver->solve(step.right_side, x, work).iterations, 0u);
  x = 1.001 * solution;
  const LinearSolve warm = solver->solve(step.right_side, x, work);
  EXPECT_TRUE(warm.status.ok());
  EXPECT_LT(warm.iterations, cold);
  EXPECT_GT(warm.iterations, 0u);
}

TEST(PetscSolver, StopsInTheNormOfTheResidualRelativeToTheRightSide) {
  // Rows of very different size: the preconditioned norm would be another one.
  ClothStep step = cloth_step(6, 2000.0, 0.02);
  Vector scale(step.matrix.cols());
  for (Index i = 0; i < scale.size(); ++i) scale[i] = i % 2 == 0 ? 1.0 : 1e3;
  step.matrix = SparseMatrix(scale.asDiagonal() * step.matrix * scale.asDiagonal());
  for (const char* method : {"cg", "gmres", "bcgs", "fgmres", "tfqmr"}) {
    LinearSolverOptions options = petsc(std::string("-pc_type jacobi -ksp_type ") + method);
    options.relative_tolerance = 1e-6;
    const PetscOutcome outcome = solve_once(options, step.matrix, step.right_side);
    EXPECT_TRUE(outcome.solve.status.ok()) << method << ": " << outcome.solve.status.describe();
    EXPECT_LT(outcome.solve.relative_residual, 1.01e-6) << method;
    EXPECT_GT(outcome.solve.relative_residual, 1e-9) << method << " worked more than it was asked to";
  }
}

TEST(PetscSolver, TakesToleranceAndLimitFromTheOptionsFirst) {
  const ClothStep step = cloth_step(8, 2000.0, 0.02);
  const PetscOutcome loose =
      solve_once(petsc("-pc_type jacobi -ksp_rtol 1e-3"), step.matrix, step.right_side);
  EXPECT_TRUE(loose.solve.status.ok()) << loose.solve.status.describe();
  EXPECT_GT(loose.solve.relative_residual, 1e-6);
  const PetscOutcome few = solve_once(petsc("-pc_type jacobi -ksp_max_it 3"), step.matrix, step.right_side);
  EXPECT_EQ(few.solve.status.code, StatusCode::linear_solver_failed);
  EXPECT_THAT(few.solve.status.message, HasSubstr("DIVERGED_ITS"));
  EXPECT_EQ(few.solve.iterations, 3u);
}

TEST(PetscSolver, NeedsFewerIterationsOfMultigridWithTheRigidBodyModes) {
  // Stiff and with a long step, so that A is close to −h²K.
  const ClothStep step = cloth_step(20, 2000.0, 1.0);
  LinearSolverOptions options = petsc("-pc_type gamg");
  const PetscOutcome without = solve_once(options, step.matrix, step.right_side);
  options.coordinates = step.coordinates;
  const PetscOutcome with = solve_once(options, step.matrix, step.right_side);
  ASSERT_TRUE(without.solve.status.ok()) << without.solve.status.describe();
  ASSERT_TRUE(with.solve.status.ok()) << with.solve.status.describe();
  EXPECT_GT(with.solve.iterations, 5u);
  EXPECT_LT(static_cast<double>(with.solve.iterations), 0.8 * static_cast<double>(without.solve.iterations));
}

TEST(PetscSolver, FailsWithPetscsReasonWhereASolverDoesNotSupportTheStorage) {
  const ClothStep step = cloth_step(8, 2000.0, 0.02);
  for (const auto& [text, storage] : {std::pair{"-pc_type pbjacobi", PetscMatrixType::sbaij},
                                      {"-pc_type sor", PetscMatrixType::sbaij},
                                      {"-pc_type ilu", PetscMatrixType::sbaij},
                                      {"-ksp_type preonly -pc_type lu", PetscMatrixType::sbaij},
                                      {"-pc_type gamg", PetscMatrixType::baij},
                                      {"-pc_type gamg", PetscMatrixType::sbaij}}) {
    const PetscOutcome outcome = solve_once(petsc(text, storage), step.matrix, step.right_side);
    const Status& status = outcome.set_up.ok() ? outcome.solve.status : outcome.set_up;
    EXPECT_EQ(status.code, StatusCode::library_failure) << text << ": " << status.describe();
    EXPECT_THAT(status.message, HasSubstr("PETSc")) << text;
  }
}

TEST(PetscSolver, DoesNotBelieveASolverThatStopsTooSoon) {
  const ClothStep step = cloth_step(8, 2000.0, 0.02);
  // One sweep of the preconditioner is taken for the solution, with a positive reason.
  const PetscOutcome outcome =
      solve_once(petsc("-ksp_type preonly -pc_type icc"), step.matrix, step.right_side);
  EXPECT_EQ(outcome.solve.status.code, StatusCode::linear_solver_failed) << outcome.solve.status.describe();
  EXPECT_THAT(outcome.solve.status.message, HasSubstr("true relative residual"));
  EXPECT_GT(outcome.solve.relative_residual, 1e-6);
}

TEST(PetscSolver, NamesAnOptionThatNobodyAsksFor) {
  const ClothStep step = cloth_step(4, 2000.0, 0.02);
  for (const char* text : {"-ksp_tpye gmres", "-pc_type jacobi -sub_pc_type icc", "-ts_type rk"}) {
    const std::string message = message_of([&] { solve_once(petsc(text), step.matrix, step.right_side); });
    EXPECT_THAT(message, HasSubstr(text));
    EXPECT_THAT(message, HasSubstr("nobody has asked for -"));
  }
}

TEST(PetscSolver, SaysWhatIsWrongWithTheValueOfAnOption) {
  const ClothStep step = cloth_step(4, 2000.0, 0.02);
  for (const auto& [text, part] : {std::pair{"-ksp_type gmress", "gmress"},
                                   {"-pc_type nonsense", "nonsense"},
                                   {"-ksp_rtol tight", "tight"},
                                   {"-ksp_rtol -3", "-3"},
                                   {"-ksp_max_it 1.5", "1.5"},
                                   {"-pc_type bjacobi -sub_pc_type nonsense", "nonsense"}}) {
    const std::string message = message_of([&] { solve_once(petsc(text), step.matrix, step.right_side); });
    EXPECT_THAT(message, HasSubstr("PETSc options")) << text;
    EXPECT_THAT(message, HasSubstr(part)) << text;
  }
  for (const char* text : {"ksp_type cg", "-ksp_type cg gmres", "cg"}) {
    EXPECT_THAT(message_of([&] { make_linear_solver(petsc(text)); }), HasSubstr("expected an option"))
        << text;
  }
}

TEST(PetscSolver, ReportsASingularMatrix) {
  ClothStep step = cloth_step(4, 2000.0, 0.02);
  for (SparseMatrix::InnerIterator entry(step.matrix, 7); entry; ++entry) {
    entry.valueRef() = 0.0;
    step.matrix.coeffRef(7, entry.row()) = 0.0;
  }
  for (const char* text :
       {"-ksp_type preonly -pc_type lu", "-ksp_type preonly -pc_type lu -pc_factor_mat_solver_type klu",
        "-ksp_type preonly -pc_type cholesky",
        "-ksp_type preonly -pc_type lu -pc_factor_mat_solver_type mumps"}) {
    const PetscOutcome outcome = solve_once(petsc(text), step.matrix, step.right_side);
    const Status& status = outcome.set_up.ok() ? outcome.solve.status : outcome.set_up;
    EXPECT_EQ(status.code, StatusCode::matrix_singular) << text << ": " << status.describe();
  }
}

TEST(PetscSolver, ReportsAnIndefiniteMatrix) {
  ClothStep step = cloth_step(4, 2000.0, 0.02);
  step.matrix.coeffs() *= -1.0;
  sparse::add_to_diagonal(step.matrix, 0.5);
  ASSERT_LT(Eigen::SelfAdjointEigenSolver<Matrix>(Matrix(step.matrix)).eigenvalues().minCoeff(), -0.1);
  ASSERT_GT(Eigen::SelfAdjointEigenSolver<Matrix>(Matrix(step.matrix)).eigenvalues().maxCoeff(), 0.1);
  for (const char* text : {"-pc_type none", "-pc_type jacobi"}) {
    const PetscOutcome outcome = solve_once(petsc(text), step.matrix, step.right_side);
    EXPECT_EQ(outcome.solve.status.code, StatusCode::matrix_indefinite) << outcome.solve.status.describe();
    EXPECT_THAT(outcome.solve.status.message, HasSubstr("KSP_DIVERGED_INDEFINITE"));
  }
}

TEST(PetscSolver, ReportsValuesThatAreNotFinite) {
  ClothStep step = cloth_step(4, 2000.0, 0.02);
  Vector b = step.right_side;
  b[5] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(solve_once(petsc(""), step.matrix, b).solve.status.code, StatusCode::non_finite);
  step.matrix.valuePtr()[11] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(solve_once(petsc(""), step.matrix, step.right_side).set_up.code, StatusCode::non_finite);
}

TEST(PetscSolver, SolvesAZeroRightHandSideByZero) {
  const ClothStep step = cloth_step(4, 2000.0, 0.02);
  Work work;
  const auto solver = make_linear_solver(petsc(""));
  ASSERT_TRUE(solver->factorise(step.matrix, work).ok());
  Vector x = Vector::Ones(step.matrix.cols());
  EXPECT_TRUE(solver->solve(Vector::Zero(x.size()), x, work).status.ok());
  EXPECT_EQ(x.norm(), 0.0);
}

TEST(PetscSolver, SolvesUnsymmetricMatricesOfEverySize) {
  for (const Index n : {30, 31}) {
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal;
    Matrix dense = 8.0 * Matrix::Identity(n, n);
    Vector b(n);
    for (Index j = 0; j < n; ++j) {
      b[j] = normal(random);
      for (Index i = 0; i < n; ++i) {
        if ((3 * i + 7 * j) % 5 == 0 && i != j) dense(i, j) = normal(random);
      }
    }
    SparseMatrix A = dense.sparseView();
    A.makeCompressed();
    for (const PetscMatrixType storage : {PetscMatrixType::aij, PetscMatrixType::baij}) {
      for (const char* text : {"-ksp_type gmres -pc_type ilu", "-ksp_type preonly -pc_type lu"}) {
        const PetscOutcome outcome = solve_once(petsc(text, storage), A, b);
        ASSERT_TRUE(outcome.set_up.ok()) << outcome.set_up.describe();
        EXPECT_TRUE(outcome.solve.status.ok()) << outcome.solve.status.describe();
        EXPECT_LT((outcome.x - dense.lu().solve(b)).norm(), 1e-8 * outcome.x.norm());
      }
    }
  }
}

TEST(PetscSolver, DoesNotBelieveATriangleOfAnUnsymmetricMatrix) {
  SparseMatrix A = cloth_step(4, 2000.0, 0.02).matrix;
  A.coeffRef(18, 15) *= 1.5;
  const Vector b = Vector::LinSpaced(A.cols(), -1.0, 2.0);
  const PetscOutcome outcome = solve_once(petsc("", PetscMatrixType::sbaij), A, b);
  EXPECT_EQ(outcome.solve.status.code, StatusCode::linear_solver_failed) << outcome.solve.status.describe();
  EXPECT_THAT(outcome.solve.status.message, HasSubstr("true relative residual"));
}

TEST(PetscSolver, KeepsTheOptionsOfTwoSolversApart) {
  const ClothStep step = cloth_step(8, 2000.0, 0.02);
  const std::uint64_t jacobi =
      solve_once(petsc("-pc_type jacobi"), step.matrix, step.right_side).solve.iterations;
  const std::uint64_t blocks =
      solve_once(petsc("-pc_type bjacobi -sub_pc_type icc"), step.matrix, step.right_side).solve.iterations;
  ASSERT_NE(jacobi, blocks);
  Work work;
  const auto first = make_linear_solver(petsc("-pc_type jacobi"));
  const auto second = make_linear_solver(petsc("-pc_type bjacobi -sub_pc_type icc"));
  ASSERT_TRUE(first->factorise(step.matrix, work).ok());
  ASSERT_TRUE(second->factorise(step.matrix, work).ok());
  for (int round = 0; round < 2; ++round) {
    Vector x = Vector::Zero(step.matrix.cols()), y = x;
    EXPECT_EQ(first->solve(step.right_side, x, work).iterations, jacobi);
    EXPECT_EQ(second->solve(step.right_side, y, work).iterations, blocks);
  }
}

TEST(PetscSolver, WorksInSeveralThreadsAndManyTimes) {
  const ClothStep step = cloth_step(5, 2000.0, 0.02);
  const Vector expected = solve_once(petsc(""), step.matrix, step.right_side).x;
  std::vector<double> differences(4, 1.0);
  std::vector<std::thread> threads;
  for (std::size_t k = 0; k < differences.size(); ++k) {
    threads.emplace_back([&, k] {
      const char* text = k % 2 == 0 ? "" : "-pc_type gamg";
      double largest = 0.0;
      for (int cycle = 0; cycle < 50; ++cycle) {
        const PetscOutcome outcome = solve_once(petsc(text), step.matrix, step.right_side);
        largest = std::max(largest, (outcome.x - expected).norm());
        EXPECT_THROW(solve_once(petsc("-pc_type nonsense"), step.matrix, step.right_side), InputError);
      }
      differences[k] = largest;
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(differences[0], 0.0) << "not the same bits in every thread";
  for (const double difference : differences) EXPECT_LT(difference, 1e-8 * expected.norm());
}

}  // namespace
}  // namespace fw::linalg
