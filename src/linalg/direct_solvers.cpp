#include "linalg/direct_solvers.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "linalg/true_residual.hpp"

namespace fw::linalg {

namespace {

/// What it means that a factorisation has failed.
template <class Factorisation>
struct Failure;
template <int Triangle, class Ordering>
struct Failure<Eigen::SimplicialLLT<SparseMatrix, Triangle, Ordering>> {
  static Status status() {
    return {StatusCode::matrix_indefinite, "Cholesky met a pivot <= 0: the matrix is not positive definite"};
  }
};
template <int Triangle, class Ordering>
struct Failure<Eigen::SimplicialLDLT<SparseMatrix, Triangle, Ordering>> {
  static Status status() { return {StatusCode::matrix_singular, "LDLT met a zero pivot"}; }
};
template <class Ordering>
struct Failure<Eigen::SparseLU<SparseMatrix, Ordering>> {
  static Status status() {
    return {StatusCode::matrix_singular, "LU met a zero pivot: the matrix is singular"};
  }
};

}  // namespace

template <class Factorisation>
Status EigenDirectSolver<Factorisation>::factorise(const SparseMatrix& A, Work& work) {
  if (take_matrix(A)) is_analysed_ = false;
  ++work.factorisations;
  if (!ConstVectorMap(matrix_.valuePtr(), matrix_.nonZeros()).allFinite()) return non_finite_matrix();
  if (!is_analysed_) {
    factorisation_.analyzePattern(matrix_);
    is_analysed_ = true;
  }
  factorisation_.factorize(matrix_);
  return factorisation_.info() == Eigen::Success ? Status{} : Failure<Factorisation>::status();
}

template <class Factorisation>
LinearSolve EigenDirectSolver<Factorisation>::solve(ConstVectorRef b, VectorRef x, Work& work) {
  x = factorisation_.solve(b);
  ++work.linear_solves;
  return judge_solution(matrix_, b, x, largest_direct_residual, residual_);
}

template <class Factorisation>
void EigenDirectSolver<Factorisation>::serialise(StateArchive& archive) {
  archive.visit("matrix", matrix_);
  if (!archive.is_loading() || matrix_.cols() == 0) return;
  Work not_counted;
  const SparseMatrix matrix = matrix_;
  is_analysed_ = false;
  factorise(matrix, not_counted);
}

template class EigenDirectSolver<Eigen::SimplicialLLT<SparseMatrix, Eigen::Lower, Eigen::AMDOrdering<int>>>;
template class EigenDirectSolver<Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, Eigen::AMDOrdering<int>>>;
template class EigenDirectSolver<Eigen::SparseLU<SparseMatrix, Eigen::COLAMDOrdering<int>>>;

SparseLuSolver::SparseLuSolver() {
  klu_defaults(&common_);
}

SparseLuSolver::~SparseLuSolver() {
  klu_free_numeric(&numeric_, &common_);
  klu_free_symbolic(&symbolic_, &common_);
}

Status SparseLuSolver::factorise(const SparseMatrix& A, Work& work) {
  if (take_matrix(A)) {
    klu_free_numeric(&numeric_, &common_);
    klu_free_symbolic(&symbolic_, &common_);
  }
  ++work.factorisations;
  int* outer = matrix_.outerIndexPtr();
  int* inner = matrix_.innerIndexPtr();
  double* values = matrix_.valuePtr();
  if (!ConstVectorMap(values, matrix_.nonZeros()).allFinite()) {
    return non_finite_matrix();
  }
  if (symbolic_ == nullptr) {
    symbolic_ = klu_analyze(static_cast<int>(matrix_.cols()), outer, inner, &common_);
    if (symbolic_ == nullptr) {
      return {StatusCode::matrix_singular,
              fmt::format("KLU cannot order the matrix (status {})", common_.status)};
    }
  }
  if (numeric_ != nullptr) {
    const double poor_pivots = 1e-12;
    if (klu_refactor(outer, inner, values, symbolic_, numeric_, &common_) == 1 && common_.status == KLU_OK &&
        klu_rcond(symbolic_, numeric_, &common_) == 1 && common_.rcond > poor_pivots) {
      keeps_old_pivots_ = true;
      return {};
    }
    klu_free_numeric(&numeric_, &common_);
  }
  pivot_values_ = ConstVectorMap(values, matrix_.nonZeros());
  keeps_old_pivots_ = false;
  numeric_ = klu_factor(outer, inner, values, symbolic_, &common_);
  if (numeric_ == nullptr || common_.status != KLU_OK) {
    klu_free_numeric(&numeric_, &common_);
    return {StatusCode::matrix_singular,
            fmt::format("KLU met a zero pivot in column {}: the matrix is singular", common_.singular_col)};
  }
  return {};
}

void SparseLuSolver::forget() {
  klu_free_numeric(&numeric_, &common_);
}

void SparseLuSolver::serialise(StateArchive& archive) {
  bool has_factors = numeric_ != nullptr;
  archive.visit("has factors", has_factors);
  archive.visit("keeps old pivots", keeps_old_pivots_);
  archive.visit("matrix", matrix_);
  if (archive.is_loading()) pivot_values_.resize(has_factors ? matrix_.nonZeros() : 0);
  if (has_factors) archive.visit("matrix of the pivots", pivot_values_);
  if (!archive.is_loading()) return;
  klu_free_numeric(&numeric_, &common_);
  klu_free_symbolic(&symbolic_, &common_);
  if (!has_factors) return;
  // Pivots come from the matrix that they were chosen for, factors from the last one.
  Work not_counted;
  const bool keeps_old_pivots = keeps_old_pivots_;
  const SparseMatrix last = matrix_;
  SparseMatrix first = matrix_;
  VectorMap(first.valuePtr(), first.nonZeros()) = pivot_values_;
  Status status = factorise(first, not_counted);
  if (status.ok() && keeps_old_pivots) status = factorise(last, not_counted);
  if (!status.ok() || keeps_old_pivots != keeps_old_pivots_) {
    throw InputError("saved state: the factors of a matrix cannot be made again from what was saved");
  }
}

LinearSolve SparseLuSolver::solve(ConstVectorRef b, VectorRef x, Work& work) {
  x = b;
  ++work.linear_solves;
  klu_solve(symbolic_, numeric_, static_cast<int>(b.size()), 1, x.data(), &common_);
  return judge_solution(matrix_, b, x, largest_direct_residual, residual_);
}

}  // namespace fw::linalg
