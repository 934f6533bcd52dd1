#pragma once

#include <vector>

#include "linalg/linear_solver.hpp"

namespace fw::linalg {

/// Conjugate gradients on a stored symmetric matrix with a block-Jacobi preconditioner: 3×3 diagonal blocks
/// (one per particle) where the size is a multiple of three, else the diagonal. Allocates at the first
/// factorisation only.
class ConjugateGradientSolver final : public LinearSolver {
 public:
  explicit ConjugateGradientSolver(LinearSolverOptions options) : options_(options) {}

  Status factorise(const SparseMatrix& A, Work& work) override;
  LinearSolve solve(ConstVectorRef b, VectorRef x, Work& work) override;

 private:
  void precondition(ConstVectorRef r, VectorRef out) const;

  LinearSolverOptions options_;
  SparseMatrix matrix_;
  std::vector<double> inverse_blocks_;  ///< column-major blocks, one after the other
  Index block_size_ = 1;
  ConjugateGradientWorkspace workspace_;
};

}  // namespace fw::linalg
