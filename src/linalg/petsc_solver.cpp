#include "linalg/petsc_solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "core/error.hpp"
#include "linalg/petsc_matrix.hpp"
#include "linalg/rigid_body_modes.hpp"
#include "linalg/true_residual.hpp"
#include "sparse/sparse_slots.hpp"

namespace fw::linalg {

namespace {

/// Krylov methods that cannot measure ‖b − A x‖₂, or have no norm at all (PETSc 3.18; `cr` offers it and then
/// stops with a false reason).
constexpr std::array<std::string_view, 10> own_norm_only = {
    KSPPREONLY, "none", KSPMINRES, KSPSYMMLQ, KSPLCD, KSPCR, KSPPIPECR, KSPPIPELCG, KSPTSIRM, KSPFETIDP};

/// Above this many iterations PETSc's counter overflows.
constexpr std::uint64_t most_iterations = 2'000'000'000;

StatusCode code_of(KSPConvergedReason reason, PCFailedReason preconditioner) {
  switch (reason) {
    case KSP_DIVERGED_INDEFINITE_PC:
    case KSP_DIVERGED_INDEFINITE_MAT:
      return StatusCode::matrix_indefinite;
    case KSP_DIVERGED_NANORINF:
      return StatusCode::non_finite;
    case KSP_DIVERGED_PC_FAILED:
      break;
    default:
      return StatusCode::linear_solver_failed;
  }
  switch (preconditioner) {
    case PC_FACTOR_STRUCT_ZEROPIVOT:
    case PC_FACTOR_NUMERIC_ZEROPIVOT:
      return StatusCode::matrix_singular;
    default:
      return StatusCode::library_failure;
  }
}

}  // namespace

/// The objects of PETSc for one pattern.
class PetscSolver::Engine {
 public:
  Engine(const SparseMatrix& A, const LinearSolverOptions& options)
      : options_(options), text_(options.petsc_options), matrix_(A, options.petsc_matrix) {
    const PetscSession session(&text_);
    const auto n = static_cast<PetscInt>(A.cols());
    petsc_check(VecCreateSeq(PETSC_COMM_SELF, n, right_side_.out()));
    petsc_check(VecDuplicate(right_side_, solution_.out()));
    petsc_check(KSPCreate(PETSC_COMM_SELF, solver_.out()));
    petsc_check(KSPSetType(solver_, KSPCG));
    petsc_check(KSPGetPC(solver_, &preconditioner_));
    petsc_check(PCSetType(preconditioner_, PCICC));
    const std::uint64_t limit =
        options.max_iterations > 0 ? options.max_iterations : 10 * static_cast<std::uint64_t>(n);
    petsc_check(KSPSetTolerances(solver_, options.relative_tolerance, 0.0, PETSC_DEFAULT,
                                 static_cast<PetscInt>(std::min(limit, most_iterations))));
    petsc_check(KSPSetOperators(solver_, matrix_.get(), matrix_.get()));
    with_options_to_blame(text_, [&] { petsc_check(KSPSetFromOptions(solver_)); });
    const char* type = nullptr;
    petsc_check(KSPGetType(solver_, &type));
    const bool only_preconditioner = type == std::string_view(KSPPREONLY) || type == std::string_view("none");
    if (std::find(own_norm_only.begin(), own_norm_only.end(), type) == own_norm_only.end() &&
        !text_.has("-ksp_norm_type") && !text_.has("-ksp_pc_side")) {
      petsc_check(KSPSetNormType(solver_, KSP_NORM_UNPRECONDITIONED));
    }
    if (!only_preconditioner) petsc_check(KSPSetInitialGuessNonzero(solver_, PETSC_TRUE));
    petsc_check(KSPGetTolerances(solver_, &tolerance_, nullptr, nullptr, nullptr));
    if (!(tolerance_ > 0.0) || !(tolerance_ < 1.0)) {
      throw InputError(fmt::format("PETSc options \"{}\": found -ksp_rtol {}, expected 0 < it < 1",
                                   text_.text(), tolerance_));
    }
    tolerance_ *= 10.0;
    if (only_preconditioner) {
      PetscBool is_direct = PETSC_FALSE;
      petsc_check(PetscObjectTypeCompareAny(reinterpret_cast<PetscObject>(preconditioner_), &is_direct, PCLU,
                                            PCCHOLESKY, PCQR, PCSVD, ""));
      is_direct_ = is_direct == PETSC_TRUE;
      if (is_direct_) tolerance_ = largest_direct_residual;
    }
  }

  bool is_direct() const { return is_direct_; }

  /// New values and a new preconditioner.
  Status set_up(const SparseMatrix& A) {
    const PetscSession session(&text_);
    PetscBool is_multigrid = PETSC_FALSE;
    petsc_check(
        PetscObjectTypeCompare(reinterpret_cast<PetscObject>(preconditioner_), PCGAMG, &is_multigrid));
    if (is_multigrid == PETSC_TRUE && options_.petsc_matrix != PetscMatrixType::aij) {
      // PETSc fails as well, but loses memory by it.
      return {StatusCode::library_failure, "PETSc's multigrid (-pc_type gamg) works on AIJ matrices only"};
    }
    matrix_.set_values(A);
    petsc_check(KSPSetReusePreconditioner(solver_, PETSC_FALSE));
    if (is_first_) {
      petsc_check(MatSetOption(matrix_.get(), MAT_SYMMETRIC, is_symmetric(A) ? PETSC_TRUE : PETSC_FALSE));
      set_near_null_space(A);
    }
    with_options_to_blame(text_, [&] {
      petsc_check(KSPSetUp(solver_));
      petsc_check(KSPSetUpOnBlocks(solver_));
    });
    const Status status = preconditioner_status();
    if (is_first_ && status.ok()) text_.check_all_used();
    is_first_ = false;
    return status;
  }

  /// New values under the old preconditioner.
  void keep_preconditioner(const SparseMatrix& A) {
    const PetscSession session(&text_);
    matrix_.set_values(A);
    petsc_check(KSPSetReusePreconditioner(solver_, PETSC_TRUE));
  }

  /// The iterations; the true residual is left to the caller.
  LinearSolve solve(ConstVectorRef b, VectorRef x) {
    const PetscSession session(&text_);
    copy(b, right_side_);
    copy(x, solution_);
    petsc_check(KSPSolve(solver_, right_side_, solution_));
    const PetscScalar* values = nullptr;
    petsc_check(VecGetArrayRead(solution_, &values));
    x = ConstVectorMap(values, x.size());
    petsc_check(VecRestoreArrayRead(solution_, &values));
    PetscInt iterations = 0;
    KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
    const char* text = nullptr;
    petsc_check(KSPGetIterationNumber(solver_, &iterations));
    petsc_check(KSPGetConvergedReason(solver_, &reason));
    petsc_check(KSPGetConvergedReasonString(solver_, &text));
    LinearSolve result;
    if (!is_direct_) result.iterations = static_cast<std::uint64_t>(iterations);
    if (reason < 0) {
      PCFailedReason failed = PC_NOERROR;
      petsc_check(PCGetFailedReason(preconditioner_, &failed));
      result.status = {
          code_of(reason, failed),
          fmt::format(
              "PETSc stopped after {} iterations: KSP_{}{}", iterations, text,
              failed == PC_NOERROR ? "" : fmt::format(", {}", PCFailedReasons[static_cast<int>(failed)]))};
    }
    return result;
  }

  /// ‖b − A x‖₂/‖b‖₂ above which a solve has failed.
  double tolerance() const { return tolerance_; }

 private:
  static void copy(ConstVectorRef from, Vec to) {
    PetscScalar* values = nullptr;
    petsc_check(VecGetArrayWrite(to, &values));
    VectorMap(values, from.size()) = from;
    petsc_check(VecRestoreArrayWrite(to, &values));
  }

  static bool is_symmetric(const SparseMatrix& A) {
    const SparseMatrix transposed = A.transpose();
    return (A - transposed).norm() <= 1e-12 * A.norm();
  }

  Status preconditioner_status() {
    PCFailedReason failed = PC_NOERROR;
    petsc_check(PCGetFailedReason(preconditioner_, &failed));
    if (failed == PC_NOERROR) return {};
    return {code_of(KSP_DIVERGED_PC_FAILED, failed), fmt::format("PETSc cannot set up the preconditioner: {}",
                                                                 PCFailedReasons[static_cast<int>(failed)])};
  }

  void set_near_null_space(const SparseMatrix& A) {
    if (options_.coordinates.size() == 0) return;
    const Matrix modes = rigid_body_modes(options_.coordinates, A);
    std::vector<PetscVec> vectors(static_cast<std::size_t>(modes.cols()));
    std::vector<Vec> list;
    for (std::size_t k = 0; k < vectors.size(); ++k) {
      petsc_check(VecDuplicate(right_side_, vectors[k].out()));
      petsc_check(VecSetBlockSize(vectors[k], matrix_.block_size()));
      copy(modes.col(static_cast<Index>(k)), vectors[k]);
      list.push_back(vectors[k]);
    }
    PetscNullSpace space;
    petsc_check(MatNullSpaceCreate(PETSC_COMM_SELF, PETSC_FALSE, static_cast<PetscInt>(list.size()),
                                   list.data(), space.out()));
    petsc_check(MatSetNearNullSpace(matrix_.get(), space));
  }

  const LinearSolverOptions& options_;
  PetscOptionText text_;
  PetscMatrix matrix_;
  PetscVec right_side_, solution_;
  PetscKsp solver_;
  PC preconditioner_ = nullptr;  ///< owned by the solver
  double tolerance_ = 0.0;
  bool is_direct_ = false;
  bool is_first_ = true;
};

PetscSolver::PetscSolver(LinearSolverOptions options) : options_(std::move(options)) {
  check_petsc_options(options_.petsc_options);
  if (!(options_.relative_tolerance > 0.0) || !(options_.relative_tolerance < 1.0)) {
    throw InputError(fmt::format("relative tolerance of the linear solver: found {}, expected 0 < it < 1",
                                 options_.relative_tolerance));
  }
}

PetscSolver::~PetscSolver() = default;

Status PetscSolver::factorise(const SparseMatrix& A, Work& work) {
  ++work.factorisations;
  if (options_.coordinates.size() != 0 && options_.coordinates.size() != A.cols()) {
    throw InputError(
        fmt::format("coordinates for PETSc: found {} numbers, expected {} as the matrix has rows",
                    options_.coordinates.size(), A.cols()));
  }
  if (take_matrix(A)) engine_.reset();
  if (!ConstVectorMap(matrix_.valuePtr(), matrix_.nonZeros()).allFinite()) return non_finite_matrix();
  try {
    if (engine_ == nullptr) engine_ = std::make_unique<Engine>(matrix_, options_);
    return engine_->set_up(matrix_);
  } catch (const PetscFailure& failure) {
    engine_.reset();  // half made objects are not used again
    return status_of(failure);
  } catch (const InputError&) {
    engine_.reset();
    throw;
  }
}

Status PetscSolver::replace_matrix(const SparseMatrix& A, Work& work) {
  if (engine_ == nullptr || engine_->is_direct() || !sparse::same_pattern(matrix_, A)) {
    return factorise(A, work);
  }
  take_matrix(A);
  if (!ConstVectorMap(matrix_.valuePtr(), matrix_.nonZeros()).allFinite()) return non_finite_matrix();
  try {
    engine_->keep_preconditioner(matrix_);
    return {};
  } catch (const PetscFailure& failure) {
    engine_.reset();
    return status_of(failure);
  }
}

void PetscSolver::forget() {
  engine_.reset();
}

void PetscSolver::serialise(StateArchive&) {
  throw InputError("the linear solver petsc cannot be saved: PETSc does not give out its memory");
}

LinearSolve PetscSolver::solve(ConstVectorRef b, VectorRef x, Work& work) {
  ++work.linear_solves;
  LinearSolve result;
  if (engine_ == nullptr) {
    result.status = {StatusCode::library_failure, "PETSc has no matrix: its factorisation has failed"};
    return result;
  }
  const double tolerance = engine_->tolerance();
  if (!b.allFinite()) return judge_solution(matrix_, b, x, tolerance, residual_);
  if (b.norm() == 0.0) {
    x.setZero();
    return result;
  }
  try {
    const LinearSolve run = engine_->solve(b, x);
    result = judge_solution(matrix_, b, x, tolerance, residual_);
    result.iterations = run.iterations;
    if (!run.status.ok()) result.status = run.status;
  } catch (const PetscFailure& failure) {
    engine_.reset();
    result.status = status_of(failure);
  }
  work.linear_iterations += result.iterations;
  return result;
}

}  // namespace fw::linalg
