#include "linalg/direct_solvers.hpp"

#include <fmt/format.h>

#include <cmath>

namespace fw::linalg {

namespace {

/// Fills in the true residual and judges it: a backward stable solve leaves far less than 1e-6.
LinearSolve judge(const SparseMatrix& A, ConstVectorRef b, ConstVectorRef x, Vector& residual) {
  LinearSolve result;
  residual = b;
  residual.noalias() -= A * x;
  const double b_norm = b.norm();
  result.relative_residual = b_norm > 0.0 ? residual.norm() / b_norm : residual.norm();
  if (!std::isfinite(result.relative_residual)) {
    result.status = {StatusCode::non_finite, "the solution of the linear system is not finite"};
  } else if (result.relative_residual > 1e-6) {
    result.status = {
        StatusCode::linear_solver_failed,
        fmt::format("the direct solver left a relative residual of {:.3g}", result.relative_residual)};
  }
  return result;
}

}  // namespace

Status SparseCholeskySolver::factorise(const SparseMatrix& A, Work& work) {
  matrix_ = A;
  if (!analysed_) {
    cholesky_.analyzePattern(matrix_);
    analysed_ = true;
  }
  cholesky_.factorize(matrix_);
  ++work.factorisations;
  if (cholesky_.info() != Eigen::Success) {
    return {StatusCode::matrix_indefinite, "Cholesky met a pivot <= 0: the matrix is not positive definite"};
  }
  return {};
}

LinearSolve SparseCholeskySolver::solve(ConstVectorRef b, VectorRef x, Work& work) {
  x = cholesky_.solve(b);
  ++work.linear_solves;
  return judge(matrix_, b, x, residual_);
}

SparseLuSolver::SparseLuSolver() {
  klu_defaults(&common_);
}

SparseLuSolver::~SparseLuSolver() {
  klu_free_numeric(&numeric_, &common_);
  klu_free_symbolic(&symbolic_, &common_);
}

Status SparseLuSolver::factorise(const SparseMatrix& A, Work& work) {
  matrix_ = A;
  ++work.factorisations;
  int* outer = matrix_.outerIndexPtr();
  int* inner = matrix_.innerIndexPtr();
  double* values = matrix_.valuePtr();
  if (!ConstVectorMap(values, matrix_.nonZeros()).allFinite()) {
    return {StatusCode::non_finite, "the matrix of the linear system is not finite"};
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
      return {};
    }
    klu_free_numeric(&numeric_, &common_);
  }
  numeric_ = klu_factor(outer, inner, values, symbolic_, &common_);
  if (numeric_ == nullptr || common_.status != KLU_OK) {
    klu_free_numeric(&numeric_, &common_);
    return {StatusCode::matrix_singular,
            fmt::format("KLU met a zero pivot in column {}: the matrix is singular", common_.singular_col)};
  }
  return {};
}

LinearSolve SparseLuSolver::solve(ConstVectorRef b, VectorRef x, Work& work) {
  x = b;
  ++work.linear_solves;
  klu_solve(symbolic_, numeric_, static_cast<int>(b.size()), 1, x.data(), &common_);
  return judge(matrix_, b, x, residual_);
}

}  // namespace fw::linalg
