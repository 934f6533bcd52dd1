#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <functional>

#include "linalg/linear_solver.hpp"
#include "linalg/petsc_matrix.hpp"
#include "linalg/simplified_newton.hpp"

namespace fw::linalg {
namespace {

/// A symmetric positive definite matrix of 3×3 blocks: a chain of particles and further pairs.
SparseMatrix network(int particles, const std::vector<std::pair<int, int>>& contacts, double stiffness) {
  Matrix dense = 2.0 * Matrix::Identity(3 * particles, 3 * particles);
  const auto join = [&](int i, int j) {
    Eigen::Matrix3d block = Eigen::Matrix3d::Constant(0.2);
    block.diagonal().setConstant(1.0 + 0.1 * i);
    block *= stiffness;
    dense.block<3, 3>(3 * i, 3 * i) += block;
    dense.block<3, 3>(3 * j, 3 * j) += block;
    dense.block<3, 3>(3 * i, 3 * j) -= block;
    dense.block<3, 3>(3 * j, 3 * i) -= block;
  };
  for (int i = 0; i + 1 < particles; ++i) join(i, i + 1);
  for (const auto& [i, j] : contacts) join(i, j);
  SparseMatrix A = dense.sparseView();
  A.makeCompressed();
  return A;
}

/// The matrices of a run: the pattern changes at the third, the fifth (as many entries, elsewhere) and the
/// seventh.
std::vector<SparseMatrix> run_of_matrices() {
  return {network(8, {}, 1.0),       network(8, {}, 2.0),       network(8, {{0, 5}}, 1.0),
          network(8, {{0, 5}}, 3.0), network(8, {{1, 4}}, 1.0), network(8, {{1, 4}}, 0.5),
          network(8, {}, 1.5)};
}
constexpr std::uint64_t patterns_of_run = 4;

Vector right_side(Index n) {
  Vector b(n);
  for (Index i = 0; i < n; ++i) b[i] = static_cast<double>((5 * i + 1) % 7) - 3.0;
  return b;
}

/// Whether the solver solves each system of the run as a dense solver does.
bool solves_run(LinearSolver& solver, bool keeps_preconditioner = false) {
  Work work;
  bool is_first = true;
  for (const SparseMatrix& A : run_of_matrices()) {
    const Status status =
        keeps_preconditioner && !is_first ? solver.replace_matrix(A, work) : solver.factorise(A, work);
    is_first = false;
    if (!status.ok()) return false;
    const Vector b = right_side(A.cols());
    Vector x = Vector::Zero(A.cols());
    if (!solver.solve(b, x, work).status.ok()) return false;
    const Vector expected = Matrix(A).lu().solve(b);
    if (!((x - expected).norm() <= 1e-9 * expected.norm())) return false;
  }
  return true;
}

/// LU that takes the pattern of its first matrix for that of all others: the seeded mistake.
class ForgetfulSolver final : public LinearSolver {
 public:
  Status factorise(const SparseMatrix& A, Work&) override {
    if (first_.size() == 0) first_ = A;
    const Index count = std::min(first_.nonZeros(), A.nonZeros());
    for (Index k = 0; k < count; ++k) first_.valuePtr()[k] = A.valuePtr()[k];
    dense_ = first_;
    return {};
  }
  Status replace_matrix(const SparseMatrix& A, Work& work) override { return factorise(A, work); }
  LinearSolve solve(ConstVectorRef b, VectorRef x, Work&) override {
    x = dense_.lu().solve(b);
    return {};
  }
  void forget() override {}
  void serialise(StateArchive&) override {}

 private:
  SparseMatrix first_;
  Matrix dense_;
};

TEST(PatternChange, IsAnalysedByEverySolverThenAndOnlyThen) {
  for (const LinearSolverInfo& info : linear_solvers()) {
    SCOPED_TRACE(info.name);
    for (const bool keeps_preconditioner : {false, true}) {
      const auto solver = make_linear_solver({.kind = info.kind, .relative_tolerance = 1e-12});
      EXPECT_TRUE(solves_run(*solver, keeps_preconditioner));
      EXPECT_EQ(solver->analyses(), patterns_of_run);
    }
  }
}

TEST(PatternChange, IsAnalysedByPetscInEveryStorage) {
  for (const PetscMatrixType type : {PetscMatrixType::aij, PetscMatrixType::baij, PetscMatrixType::sbaij}) {
    for (const char* options : {"-ksp_type cg -pc_type icc", "-ksp_type preonly -pc_type cholesky"}) {
      const auto solver = make_linear_solver({.kind = LinearSolverKind::petsc,
                                              .relative_tolerance = 1e-12,
                                              .petsc_options = options,
                                              .petsc_matrix = type});
      EXPECT_TRUE(solves_run(*solver)) << options;
      EXPECT_EQ(solver->analyses(), patterns_of_run);
    }
  }
}

TEST(PatternChange, GivesAWrongSolutionWhereASolverForgetsToAnalyse) {
  ForgetfulSolver solver;
  EXPECT_FALSE(solves_run(solver));
}

TEST(PatternChange, KeepsPetscsMatrixOfRowsAndRaisesItsNonzeroState) {
  const SparseMatrix before = network(8, {{0, 5}}, 1.0), after = network(8, {{1, 4}}, 3.0);
  ASSERT_EQ(before.nonZeros(), after.nonZeros());
  const PetscSession session;
  EXPECT_THROW(PetscMatrix(before, PetscMatrixType::baij).set_pattern(after), std::logic_error);
  {
    PetscMatrix matrix(before, PetscMatrixType::aij);
    matrix.set_values(before);
    const Mat object = matrix.get();
    PetscObjectState old_state = 0, new_state = 0;
    petsc_check(MatGetNonzeroState(object, &old_state));
    matrix.set_pattern(after);
    matrix.set_values(after);
    petsc_check(MatGetNonzeroState(object, &new_state));
    EXPECT_EQ(matrix.get(), object);
    EXPECT_GT(new_state, old_state);
    const Vector x = right_side(after.cols());
    PetscVec in, out;
    petsc_check(VecCreateSeq(PETSC_COMM_SELF, static_cast<PetscInt>(x.size()), in.out()));
    petsc_check(VecDuplicate(in, out.out()));
    PetscScalar* values = nullptr;
    petsc_check(VecGetArrayWrite(in, &values));
    VectorMap(values, x.size()) = x;
    petsc_check(VecRestoreArrayWrite(in, &values));
    petsc_check(MatMult(object, in, out));
    petsc_check(VecGetArray(out, &values));
    EXPECT_LT((Vector(VectorMap(values, x.size())) - after * x).norm(), 1e-12 * x.norm());
    petsc_check(VecRestoreArray(out, &values));
  }
}

/// g(u) = A u + u³/10 − b with the matrices of the run, one after the other.
class CubicNetwork final : public NewtonProblem {
 public:
  void use(std::size_t k) {
    const SparseMatrix& next = matrices_[k];
    if (k == 2 || k == 4 || k == 6) ++revision_;
    current_ = next;
  }
  void residual(ConstVectorRef u, VectorRef out) override {
    out = current_ * u - right_side(u.size());
    out.array() += 0.1 * u.array().cube();
  }
  const SparseMatrix& matrix(ConstVectorRef u) override {
    ++matrices_made;
    jacobian_ = current_;
    for (Index i = 0; i < u.size(); ++i) jacobian_.coeffRef(i, i) += 0.3 * u[i] * u[i];
    return jacobian_;
  }
  std::uint64_t pattern_revision() const override { return revision_; }
  std::size_t count() const { return matrices_.size(); }

  int matrices_made = 0;

 private:
  std::vector<SparseMatrix> matrices_ = run_of_matrices();
  SparseMatrix current_ = matrices_.front(), jacobian_;
  std::uint64_t revision_ = 0;
};

/// Whether the iteration `solve(problem, u)` finds a root of every system of the run.
bool finds_roots(const std::function<Status(CubicNetwork&, VectorRef)>& solve) {
  CubicNetwork problem;
  Vector u = Vector::Zero(24), g(24);
  for (std::size_t k = 0; k < problem.count(); ++k) {
    problem.use(k);
    if (!solve(problem, u).ok()) return false;
    problem.residual(u, g);
    if (!(g.norm() <= 1e-9)) return false;
  }
  return true;
}

TEST(PatternChange, IsFollowedByNewtonsIteration) {
  auto solver = default_direct_solver();
  const LinearSolver& watched = *solver;
  Newton newton(24, std::move(solver));
  Work work;
  EXPECT_TRUE(finds_roots([&](CubicNetwork& p, VectorRef u) { return newton.solve(p, u, 1.0, work); }));
  EXPECT_EQ(watched.analyses(), patterns_of_run);
  EXPECT_GT(work.factorisations, 2 * patterns_of_run);
}

TEST(PatternChange, MakesNewtonsIterationFailWithASolverThatForgetsToAnalyse) {
  Newton newton(24, std::make_unique<ForgetfulSolver>());
  Work work;
  EXPECT_FALSE(finds_roots([&](CubicNetwork& p, VectorRef u) { return newton.solve(p, u, 1.0, work); }));
}

TEST(PatternChange, EndsTheLifeOfTheMatrixThatSimplifiedNewtonKeeps) {
  // A matrix is never slow enough to be renewed for its rate alone.
  SimplifiedNewton newton(24, {.rate_of_renewal = 0.999});
  Work work;
  CubicNetwork problem;
  Vector u = Vector::Zero(24);
  std::vector<int> made;
  for (std::size_t k = 0; k < problem.count(); ++k) {
    problem.use(k);
    const int before = problem.matrices_made;
    ASSERT_TRUE(newton.solve(problem, u, 1.0, 1.0, 0.0, work).ok());
    made.push_back(problem.matrices_made - before);
  }
  EXPECT_GE(made[0], 1);
  for (const std::size_t k : {2u, 4u, 6u})
    EXPECT_GE(made[k], 1) << "matrix " << k << " is of another pattern";
}

TEST(PatternChange, IsNotSeenWhereNothingChanges) {
  SimplifiedNewton newton(24, {.rate_of_renewal = 0.999});
  Work work;
  CubicNetwork problem;
  problem.use(2);
  Vector u = Vector::Zero(24);
  for (int k = 0; k < 4; ++k) ASSERT_TRUE(newton.solve(problem, u, 1.0, 1.0, 0.0, work).ok());
  EXPECT_EQ(problem.matrices_made, 1);
}

}  // namespace
}  // namespace fw::linalg
