#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/work.hpp"
#include "linalg/conjugate_gradient.hpp"

namespace fw::linalg {

/// A solver of A x = b for sparse A whose pattern stays the same over a run.
class LinearSolver {
 public:
  virtual ~LinearSolver() = default;

  /// Takes the values of A (copied or factorised); the pattern is analysed at the first call only. Failures:
  /// matrix_singular (LU), matrix_indefinite (Cholesky, block-Jacobi).
  virtual Status factorise(const SparseMatrix& A, Work& work) = 0;

  /// Solves with the last `A`. `x` is the initial guess of an iterative solver. Every solver reports its true
  /// residual, and one that does not reach the tolerance has failed.
  virtual LinearSolve solve(ConstVectorRef b, VectorRef x, Work& work) = 0;
};

enum class LinearSolverKind {
  conjugate_gradient,  ///< symmetric positive definite; block-Jacobi preconditioner (3×3)
  sparse_cholesky,     ///< symmetric positive definite; LLᵀ with approximate minimum degree ordering
  sparse_lu,           ///< any regular matrix; KLU [Davis, Palamadai Natarajan 2010]
};

struct LinearSolverOptions {
  LinearSolverKind kind = LinearSolverKind::conjugate_gradient;
  double relative_tolerance = 1e-10;  ///< of conjugate gradients
  std::uint64_t max_iterations = 0;   ///< of conjugate gradients; 0: ten times the number of unknowns
};

std::unique_ptr<LinearSolver> make_linear_solver(const LinearSolverOptions& options);

}  // namespace fw::linalg
