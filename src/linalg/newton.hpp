#pragma once

#include <memory>

#include "linalg/linear_solver.hpp"

namespace fw::linalg {

/// A nonlinear system g(u) = 0 with its sparse derivative.
class NewtonProblem {
 public:
  virtual ~NewtonProblem() = default;
  /// out = g(u).
  virtual void residual(ConstVectorRef u, VectorRef out) = 0;
  /// ∂g/∂u. Its pattern is the same as long as `pattern_revision` is.
  virtual const SparseMatrix& matrix(ConstVectorRef u) = 0;
  /// Changes when the pattern of the matrix does, never during a solve: a matrix of another revision is not
  /// used any more.
  virtual std::uint64_t pattern_revision() const { return 0; }
};

/// Newton's iteration with a new matrix at each iterate and a halved correction where the full one would not
/// decrease ‖g‖₂. All work space is allocated at construction.
class Newton {
 public:
  /// `size`: the number of unknowns.
  explicit Newton(Index size, std::unique_ptr<LinearSolver> solver = default_direct_solver());

  /// Solves g(u) = 0 from the initial guess `u`. Converged when a full correction is at most
  /// 1e-12·max(‖u‖∞, scale), or has stopped falling below 1e-8 of that (rounding); `problem.residual` has
  /// then been evaluated last at the returned `u`. Fails with newton_failed or with the linear solver's
  /// Status.
  Status solve(NewtonProblem& problem, VectorRef u, double scale, Work& work);

  /// Forgets the factors: the next solve works as the first one did.
  void forget_matrix() { solver_->forget(); }
  /// Visits what the next solve depends on.
  void serialise(StateArchive& archive) { solver_->serialise(archive); }

 private:
  std::unique_ptr<LinearSolver> solver_;
  Vector residual_, correction_, trial_;
};

}  // namespace fw::linalg
