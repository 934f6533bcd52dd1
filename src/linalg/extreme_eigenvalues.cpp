#include "linalg/extreme_eigenvalues.hpp"

#include <fmt/format.h>
#include <slepceps.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>
#include <random>

#include "core/error.hpp"
#include "linalg/petsc_matrix.hpp"
#include "linalg/true_residual.hpp"

namespace fw::linalg {

namespace {

using SlepcEps = PetscOwner<EPS, EPSDestroy>;

constexpr std::uint64_t start_vector_seed = 20031;

EPSWhich which_of(SpectrumEnd end) {
  switch (end) {
    case SpectrumEnd::largest_magnitude:
      return EPS_LARGEST_MAGNITUDE;
    case SpectrumEnd::smallest_magnitude:
      return EPS_TARGET_MAGNITUDE;
    case SpectrumEnd::largest_real:
      return EPS_LARGEST_REAL;
    case SpectrumEnd::smallest_real:
      return EPS_SMALLEST_REAL;
  }
  return EPS_LARGEST_MAGNITUDE;
}

const char* name_of(EPSConvergedReason reason) {
  switch (reason) {
    case EPS_DIVERGED_ITS:
      return "EPS_DIVERGED_ITS";
    case EPS_DIVERGED_BREAKDOWN:
      return "EPS_DIVERGED_BREAKDOWN";
    case EPS_DIVERGED_SYMMETRY_LOST:
      return "EPS_DIVERGED_SYMMETRY_LOST";
    default:
      return "converged";
  }
}

SparseMatrix diagonal(const Vector& mass) {
  SparseMatrix M(mass.size(), mass.size());
  for (int i = 0; i < mass.size(); ++i) M.insert(i, i) = mass[i];
  M.makeCompressed();
  return M;
}

/// Shift and invert at 0: KLU, since PETSc's own factorisation does not pivot.
void invert_at_zero(EPS solver) {
  ST transformation = nullptr;
  KSP linear = nullptr;
  PC factorisation = nullptr;
  petsc_check(EPSSetTarget(solver, 0.0));
  petsc_check(EPSGetST(solver, &transformation));
  petsc_check(STSetType(transformation, STSINVERT));
  petsc_check(STGetKSP(transformation, &linear));
  petsc_check(KSPSetType(linear, KSPPREONLY));
  petsc_check(KSPGetPC(linear, &factorisation));
  petsc_check(PCSetType(factorisation, PCLU));
  petsc_check(PCFactorSetMatSolverType(factorisation, MATSOLVERKLU));
}

void start_from_seed(EPS solver, PetscInt n) {
  std::mt19937_64 random(start_vector_seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  PetscVec start;
  petsc_check(VecCreateSeq(PETSC_COMM_SELF, n, start.out()));
  PetscScalar* values = nullptr;
  petsc_check(VecGetArrayWrite(start, &values));
  for (PetscInt i = 0; i < n; ++i) values[i] = uniform(random);
  petsc_check(VecRestoreArrayWrite(start, &values));
  Vec list[] = {start};
  petsc_check(EPSSetInitialSpace(solver, 1, list));
}

Vector eigenvector(EPS solver, PetscInt i, Index size) {
  PetscVec part;
  petsc_check(VecCreateSeq(PETSC_COMM_SELF, static_cast<PetscInt>(size), part.out()));
  petsc_check(EPSGetEigenvector(solver, i, part, nullptr));
  const PetscScalar* values = nullptr;
  petsc_check(VecGetArrayRead(part, &values));
  Vector vector = ConstVectorMap(values, size);
  petsc_check(VecRestoreArrayRead(part, &values));
  return vector / vector.norm();
}

void collect(EPS solver, Index size, const EigenvalueOptions& options, ExtremeEigenvalues& result) {
  const int count = options.count;
  PetscInt converged = 0, iterations = 0;
  EPSConvergedReason reason = EPS_CONVERGED_ITERATING;
  petsc_check(EPSGetConverged(solver, &converged));
  petsc_check(EPSGetIterationNumber(solver, &iterations));
  petsc_check(EPSGetConvergedReason(solver, &reason));
  result.iterations = iterations;
  for (PetscInt i = 0; i < std::min<PetscInt>(converged, count); ++i) {
    PetscScalar real = 0.0, imaginary = 0.0;
    PetscReal error = 0.0;
    petsc_check(EPSGetEigenvalue(solver, i, &real, &imaginary));
    petsc_check(EPSComputeError(solver, i, EPS_ERROR_RELATIVE, &error));
    result.values.emplace_back(real, imaginary);
    result.residuals.push_back(error);
    if (options.vectors) result.vectors.push_back(eigenvector(solver, i, size));
  }
  if (converged < count) {
    result.status = {StatusCode::linear_solver_failed,
                     fmt::format("SLEPc found {} of {} eigenvalues after {} restarts: {}", converged, count,
                                 iterations, name_of(reason))};
  }
}

void check(Index rows, Index columns, const EigenvalueOptions& options) {
  if (rows != columns || rows == 0) {
    throw InputError(
        fmt::format("eigenvalues: found {} x {} entries, expected a square matrix", rows, columns));
  }
  if (options.count < 1 || options.count > rows) {
    throw InputError(fmt::format("eigenvalues: found count {}, expected 1 to {}", options.count, rows));
  }
  if (!(options.tolerance > 0.0)) {
    throw InputError(fmt::format("eigenvalues: found tolerance {}, expected > 0", options.tolerance));
  }
}

/// The eigenvalues of A x = λ B x, B null: the identity.
void solve(Mat A, Mat B, Index size, EPSProblemType type, const EigenvalueOptions& options,
           const PetscOptionText& text, ExtremeEigenvalues& result) {
  SlepcEps solver;
  petsc_check(EPSCreate(PETSC_COMM_SELF, solver.out()));
  petsc_check(EPSSetOperators(solver, A, B));
  petsc_check(EPSSetProblemType(solver, type));
  petsc_check(EPSSetType(solver, EPSKRYLOVSCHUR));
  petsc_check(EPSSetWhichEigenpairs(solver, which_of(options.end)));
  petsc_check(EPSSetDimensions(solver, options.count, PETSC_DEFAULT, PETSC_DEFAULT));
  petsc_check(EPSSetTolerances(solver, options.tolerance,
                               options.max_iterations > 0 ? options.max_iterations : PETSC_DEFAULT));
  if (options.end == SpectrumEnd::smallest_magnitude) invert_at_zero(solver);
  start_from_seed(solver, static_cast<PetscInt>(size));
  with_options_to_blame(text, [&] { petsc_check(EPSSetFromOptions(solver)); });
  petsc_check(EPSSetUp(solver));
  text.check_all_used();
  petsc_check(EPSSolve(solver));
  collect(solver, size, options, result);
}

ExtremeEigenvalues solve(SparseMatrix A, const Vector* mass, EPSProblemType type,
                         const EigenvalueOptions& options) {
  check(A.rows(), A.cols(), options);
  if (mass != nullptr && (mass->size() != A.rows() || !(mass->minCoeff() > 0.0))) {
    throw InputError(fmt::format("eigenvalues: expected {} masses > 0", A.rows()));
  }
  const PetscOptionText text(options.petsc);
  ExtremeEigenvalues result;
  A.makeCompressed();
  if (!ConstVectorMap(A.valuePtr(), A.nonZeros()).allFinite()) {
    result.status = non_finite_matrix();
    return result;
  }
  try {
    const PetscSession session(&text);
    PetscMatrix matrix(A, PetscMatrixType::aij);
    matrix.set_values(A);
    std::unique_ptr<PetscMatrix> mass_matrix;
    if (mass != nullptr) {
      const SparseMatrix M = diagonal(*mass);
      mass_matrix = std::make_unique<PetscMatrix>(M, PetscMatrixType::aij);
      mass_matrix->set_values(M);
    }
    solve(matrix.get(), mass_matrix ? mass_matrix->get() : nullptr, A.rows(), type, options, text, result);
  } catch (const PetscFailure& failure) {
    result.status = status_of(failure);
  }
  return result;
}

/// What PETSc's shell matrix knows.
struct Shell {
  const MatrixProduct& product;
  Index size;
  std::exception_ptr thrown{};
};

PetscErrorCode multiply(Mat A, Vec x, Vec y) {
  void* context = nullptr;
  PetscCall(MatShellGetContext(A, &context));
  auto& shell = *static_cast<Shell*>(context);
  const PetscScalar* in = nullptr;
  PetscScalar* out = nullptr;
  PetscCall(VecGetArrayRead(x, &in));
  PetscCall(VecGetArrayWrite(y, &out));
  // An error would leave PETSc's objects behind: after a failure its products are 0, and the search ends.
  VectorMap image(out, shell.size);
  image.setZero();
  try {
    if (!shell.thrown) shell.product(ConstVectorMap(in, shell.size), image);
  } catch (...) {
    shell.thrown = std::current_exception();
    image.setZero();
  }
  PetscCall(VecRestoreArrayWrite(y, &out));
  PetscCall(VecRestoreArrayRead(x, &in));
  return 0;
}

}  // namespace

ExtremeEigenvalues extreme_eigenvalues_symmetric(const SparseMatrix& A, const EigenvalueOptions& options) {
  return solve(A, nullptr, EPS_HEP, options);
}

ExtremeEigenvalues extreme_eigenvalues_symmetric(const SparseMatrix& K, const Vector& mass,
                                                 const EigenvalueOptions& options) {
  return solve(K, &mass, EPS_GHEP, options);
}

ExtremeEigenvalues extreme_eigenvalues_symmetric(Index size, const MatrixProduct& product,
                                                 const EigenvalueOptions& options) {
  check(size, size, options);
  if (options.end == SpectrumEnd::smallest_magnitude) {
    throw InputError("eigenvalues: the smallest in magnitude are found with a matrix, not with its products");
  }
  const PetscOptionText text(options.petsc);
  ExtremeEigenvalues result;
  Shell shell{product, size};
  try {
    const PetscSession session(&text);
    const auto n = static_cast<PetscInt>(size);
    PetscMat matrix;
    petsc_check(MatCreateShell(PETSC_COMM_SELF, n, n, n, n, &shell, matrix.out()));
    petsc_check(MatShellSetOperation(matrix, MATOP_MULT, reinterpret_cast<void (*)()>(&multiply)));
    solve(matrix, nullptr, size, EPS_HEP, options, text, result);
  } catch (const PetscFailure& failure) {
    result.status = status_of(failure);
  }
  if (shell.thrown) std::rethrow_exception(shell.thrown);
  return result;
}

ExtremeEigenvalues extreme_eigenvalues(const SparseMatrix& A, const EigenvalueOptions& options) {
  return solve(A, nullptr, EPS_NHEP, options);
}

}  // namespace fw::linalg
