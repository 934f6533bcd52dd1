#pragma once

#include <Eigen/IterativeLinearSolvers>
#include <vector>

#include "linalg/linear_solver.hpp"
#include "sparse/block_matrix3.hpp"

namespace fw::linalg {

/// Conjugate gradients on a stored symmetric matrix with a block-Jacobi preconditioner: 3×3 diagonal blocks
/// (one per particle) where the size is a multiple of three, else the diagonal. Allocates for a new
/// pattern only.
class ConjugateGradientSolver final : public LinearSolver {
 public:
  explicit ConjugateGradientSolver(LinearSolverOptions options) : options_(options) {}

  Status factorise(const SparseMatrix& A, Work& work) override;
  Status replace_matrix(const SparseMatrix& A, Work& work) override;
  LinearSolve solve(ConstVectorRef b, VectorRef x, Work& work) override;
  void forget() override {}
  void serialise(StateArchive& archive) override;

 private:
  void precondition(ConstVectorRef r, VectorRef out) const;

  LinearSolverOptions options_;
  sparse::BlockMatrix3 blocks_;         ///< the matrix where blocks are 3×3
  std::vector<double> inverse_blocks_;  ///< column-major blocks, one after the other
  Index block_size_ = 1;
  ConjugateGradientWorkspace workspace_;
};

/// Eigen's diagonal preconditioner, which can be kept while the matrix changes.
class KeptDiagonal : public Eigen::DiagonalPreconditioner<double> {
 public:
  template <class MatrixType>
  KeptDiagonal& compute(const MatrixType& matrix) {
    if (!keep) Eigen::DiagonalPreconditioner<double>::compute(matrix);
    return *this;
  }
  bool keep = false;
};

/// Eigen's conjugate gradients with a diagonal preconditioner, as a textbook would call it. Its own
/// estimate of the residual is not believed: the true one decides.
class EigenConjugateGradientSolver final : public LinearSolver {
 public:
  explicit EigenConjugateGradientSolver(const LinearSolverOptions& options);

  Status factorise(const SparseMatrix& A, Work& work) override;
  Status replace_matrix(const SparseMatrix& A, Work& work) override;
  LinearSolve solve(ConstVectorRef b, VectorRef x, Work& work) override;
  void forget() override {}
  void serialise(StateArchive& archive) override;

 private:
  LinearSolverOptions options_;
  Eigen::ConjugateGradient<SparseMatrix, Eigen::Lower | Eigen::Upper, KeptDiagonal> solver_;
  Vector residual_;
};

}  // namespace fw::linalg
