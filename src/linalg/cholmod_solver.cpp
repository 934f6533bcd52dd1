#include "linalg/cholmod_solver.hpp"

#include <fmt/format.h>

#include "linalg/true_residual.hpp"

namespace fw::linalg {

CholmodSolver::CholmodSolver() {
  cholmod_start(&common_);
  common_.supernodal = CHOLMOD_SUPERNODAL;
  common_.print = 0;
  common_.quick_return_if_not_posdef = 1;
}

CholmodSolver::~CholmodSolver() {
  cholmod_free_factor(&factor_, &common_);
  cholmod_free_dense(&solution_, &common_);
  cholmod_free_dense(&work_y_, &common_);
  cholmod_free_dense(&work_e_, &common_);
  cholmod_finish(&common_);
}

cholmod_sparse CholmodSolver::view() {
  cholmod_sparse sparse{};
  sparse.nrow = static_cast<std::size_t>(matrix_.rows());
  sparse.ncol = static_cast<std::size_t>(matrix_.cols());
  sparse.nzmax = static_cast<std::size_t>(matrix_.nonZeros());
  sparse.p = matrix_.outerIndexPtr();
  sparse.i = matrix_.innerIndexPtr();
  sparse.x = matrix_.valuePtr();
  sparse.stype = -1;
  sparse.itype = CHOLMOD_INT;
  sparse.xtype = CHOLMOD_REAL;
  sparse.dtype = CHOLMOD_DOUBLE;
  sparse.sorted = 1;
  sparse.packed = 1;
  return sparse;
}

Status CholmodSolver::factorise(const SparseMatrix& A, Work& work) {
  if (take_matrix(A)) cholmod_free_factor(&factor_, &common_);
  ++work.factorisations;
  if (!ConstVectorMap(matrix_.valuePtr(), matrix_.nonZeros()).allFinite()) return non_finite_matrix();
  cholmod_sparse sparse = view();
  if (factor_ == nullptr) factor_ = cholmod_analyze(&sparse, &common_);
  if (factor_ == nullptr) {
    return {StatusCode::library_failure,
            fmt::format("CHOLMOD cannot order the matrix (status {})", common_.status)};
  }
  cholmod_factorize(&sparse, factor_, &common_);
  if (common_.status == CHOLMOD_NOT_POSDEF || factor_->minor < factor_->n) {
    return {StatusCode::matrix_indefinite,
            fmt::format("CHOLMOD met a pivot <= 0 in column {}: the matrix is not positive definite",
                        factor_->minor)};
  }
  if (common_.status < CHOLMOD_OK) {
    return {StatusCode::library_failure, fmt::format("CHOLMOD failed with status {}", common_.status)};
  }
  return {};
}

void CholmodSolver::serialise(StateArchive& archive) {
  archive.visit("matrix", matrix_);
  if (!archive.is_loading() || matrix_.cols() == 0) return;
  Work not_counted;
  const SparseMatrix matrix = matrix_;
  factorise(matrix, not_counted);
}

LinearSolve CholmodSolver::solve(ConstVectorRef b, VectorRef x, Work& work) {
  ++work.linear_solves;
  cholmod_dense right{};
  right.nrow = right.d = right.nzmax = static_cast<std::size_t>(b.size());
  right.ncol = 1;
  right.x = const_cast<double*>(b.data());  // CHOLMOD reads it only
  right.xtype = CHOLMOD_REAL;
  right.dtype = CHOLMOD_DOUBLE;
  if (cholmod_solve2(CHOLMOD_A, factor_, &right, nullptr, &solution_, nullptr, &work_y_, &work_e_,
                     &common_) == 0) {
    LinearSolve failed;
    failed.status = {StatusCode::library_failure,
                     fmt::format("CHOLMOD cannot solve (status {})", common_.status)};
    return failed;
  }
  x = ConstVectorMap(static_cast<const double*>(solution_->x), b.size());
  return judge_solution(matrix_, b, x, largest_direct_residual, residual_);
}

}  // namespace fw::linalg
