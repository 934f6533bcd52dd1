#include "linalg/krylov_solvers.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>

#include "linalg/true_residual.hpp"
#include "sparse/sparse_slots.hpp"

namespace fw::linalg {

namespace {

using Block = Eigen::Matrix3d;
using BlockMap = sparse::BlockMatrix3::Block;

}  // namespace

Status ConjugateGradientSolver::factorise(const SparseMatrix& A, Work& work) {
  const Index n = A.cols();
  block_size_ = n % 3 == 0 ? 3 : 1;
  if (take_matrix(A)) {
    inverse_blocks_.resize(static_cast<std::size_t>(n * block_size_));
    if (block_size_ == 3) blocks_ = sparse::BlockMatrix3(matrix_);
  }
  ++work.factorisations;
  if (!ConstVectorMap(matrix_.valuePtr(), matrix_.nonZeros()).allFinite()) return non_finite_matrix();
  if (block_size_ == 3) blocks_.take_values(matrix_);
  for (Index first = 0; first < n; first += block_size_) {
    Block block = Block::Identity();
    if (block_size_ == 3) {
      block = blocks_.diagonal(first / 3);
    } else {
      block(0, 0) = matrix_.coeff(first, first);
    }
    const Eigen::LLT<Block> cholesky(block);
    if (cholesky.info() != Eigen::Success) {
      return {
          StatusCode::matrix_indefinite,
          fmt::format("the diagonal block of row {} is not positive definite, so the matrix is not", first)};
    }
    const Block inverse = cholesky.solve(Block::Identity());
    for (Index column = 0; column < block_size_; ++column) {
      for (Index row = 0; row < block_size_; ++row) {
        inverse_blocks_[static_cast<std::size_t>((first + column) * block_size_ + row)] =
            inverse(row, column);
      }
    }
  }
  return {};
}

Status ConjugateGradientSolver::replace_matrix(const SparseMatrix& A, Work& work) {
  if (!sparse::same_pattern(matrix_, A)) return factorise(A, work);
  take_matrix(A);
  if (block_size_ == 3) blocks_.take_values(matrix_);
  return {};
}

void ConjugateGradientSolver::serialise(StateArchive& archive) {
  archive.visit("matrix", matrix_);
  std::uint64_t block_size = static_cast<std::uint64_t>(block_size_);
  archive.visit("block size", block_size);
  block_size_ = static_cast<Index>(block_size);
  if (archive.is_loading()) inverse_blocks_.resize(static_cast<std::size_t>(matrix_.cols()) * block_size);
  archive.visit("preconditioner", inverse_blocks_);
}

void ConjugateGradientSolver::precondition(ConstVectorRef r, VectorRef out) const {
  if (block_size_ == 1) {
    out = r.cwiseProduct(ConstVectorMap(inverse_blocks_.data(), r.size()));
    return;
  }
  for (Index first = 0; first < r.size(); first += 3) {
    out.segment<3>(first).noalias() = BlockMap(inverse_blocks_.data() + 3 * first) * r.segment<3>(first);
  }
}

LinearSolve ConjugateGradientSolver::solve(ConstVectorRef b, VectorRef x, Work& work) {
  const std::uint64_t limit =
      options_.max_iterations > 0 ? options_.max_iterations : 10 * static_cast<std::uint64_t>(b.size());
  // A is symmetric: its transpose is stored by rows, so the product gathers instead of scattering.
  const auto apply = [this](ConstVectorRef p, VectorRef out) {
    if (block_size_ == 3) {
      blocks_.transposed_product(p, out);
    } else {
      out.noalias() = matrix_.transpose() * p;
    }
  };
  const auto jacobi = [this](ConstVectorRef r, VectorRef out) { precondition(r, out); };
  LinearSolve result =
      conjugate_gradient(apply, jacobi, b, x, options_.relative_tolerance, limit, workspace_);
  ++work.linear_solves;
  work.linear_iterations += result.iterations;
  return result;
}

EigenConjugateGradientSolver::EigenConjugateGradientSolver(const LinearSolverOptions& options)
    : options_(options) {
  solver_.setTolerance(options_.relative_tolerance);
}

Status EigenConjugateGradientSolver::factorise(const SparseMatrix& A, Work& work) {
  take_matrix(A);
  ++work.factorisations;
  if (!ConstVectorMap(matrix_.valuePtr(), matrix_.nonZeros()).allFinite()) return non_finite_matrix();
  solver_.compute(matrix_);
  return {};
}

Status EigenConjugateGradientSolver::replace_matrix(const SparseMatrix& A, Work& work) {
  if (!sparse::same_pattern(matrix_, A)) return factorise(A, work);
  take_matrix(A);
  if (!ConstVectorMap(matrix_.valuePtr(), matrix_.nonZeros()).allFinite()) return non_finite_matrix();
  solver_.preconditioner().keep = true;
  solver_.compute(matrix_);
  solver_.preconditioner().keep = false;
  return {};
}

void EigenConjugateGradientSolver::serialise(StateArchive& archive) {
  archive.visit("matrix", matrix_);
  if (!archive.is_loading() || matrix_.cols() == 0) return;
  Work not_counted;
  const SparseMatrix matrix = matrix_;
  factorise(matrix, not_counted);
}

LinearSolve EigenConjugateGradientSolver::solve(ConstVectorRef b, VectorRef x, Work& work) {
  const std::uint64_t limit =
      options_.max_iterations > 0 ? options_.max_iterations : 10 * static_cast<std::uint64_t>(b.size());
  solver_.setMaxIterations(static_cast<Index>(limit));
  ++work.linear_solves;
  x = solver_.solveWithGuess(b, x);
  LinearSolve result = judge_solution(matrix_, b, x, 10.0 * options_.relative_tolerance, residual_);
  result.iterations = static_cast<std::uint64_t>(solver_.iterations());
  work.linear_iterations += result.iterations;
  return result;
}

}  // namespace fw::linalg
