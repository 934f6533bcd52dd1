#pragma once

#include <memory>

#include "linalg/newton.hpp"

namespace fw::linalg {

struct SimplifiedNewtonOptions {
  std::unique_ptr<LinearSolver> (*make_solver)() = default_direct_solver;
  /// The iteration ends when the remaining error, estimated by θ/(1 − θ)·‖correction‖∞, is at most this
  /// fraction of the scale. The default is the level of rounding, so that the iteration never limits an
  /// observed order.
  double tolerance = 1e-15;
  /// A rate of convergence θ above this asks for a new matrix at the next solve; 0: a new one at each.
  double rate_of_renewal = 0.1;
};

/// Newton's iteration with one factorised matrix that is kept, over iterations and over solves, while its
/// rate of convergence θ_k = ‖δ_k‖/‖δ_{k−1}‖ is good [Hairer, Wanner 1996, IV.8]. Where it diverges with an
/// old matrix it starts again with a new one, and where it diverges with a new matrix the damped `Newton`
/// takes over. A matrix of another `pattern_revision` of the problem is not kept. All work space is allocated
/// at construction, but for the factorisations of the linear solver.
class SimplifiedNewton {
 public:
  SimplifiedNewton(Index size, const SimplifiedNewtonOptions& options);

  /// Solves g(u) = 0 from the initial guess `u`. `parameter` identifies the family of matrices (the step
  /// times a coefficient): a matrix made for another value is not used. Corrections are measured against
  /// max(‖u‖∞, scale); `floor` is the size of corrections that are rounding noise of g.
  /// On success `problem.residual` has been evaluated last at the returned `u`. Fails with newton_failed,
  /// non_finite or with the linear solver's Status.
  Status solve(NewtonProblem& problem, VectorRef u, double parameter, double scale, double floor, Work& work);

  /// Solves with the matrix factorised last: x = G⁻¹ b. There must be one.
  Status solve_linear(ConstVectorRef b, VectorRef x, Work& work);
  bool has_matrix() const { return has_matrix_; }

  /// Forgets the factors: the next solve works as the first one did.
  void forget_matrix();
  /// Visits what the next solve depends on.
  void serialise(StateArchive& archive);

 private:
  enum class Outcome { converged, diverged, failed };
  Outcome iterate(NewtonProblem& problem, VectorRef u, double scale, double floor, Work& work);
  Status renew(NewtonProblem& problem, ConstVectorRef u, double parameter, Work& work);

  SimplifiedNewtonOptions options_;
  std::unique_ptr<LinearSolver> solver_;
  Newton damped_;
  Vector residual_, correction_, start_;
  double parameter_ = 0.0;
  std::uint64_t revision_ = 0;  ///< of the pattern of the matrix
  bool has_matrix_ = false;
  bool is_slow_ = false;
  Status failure_;
};

}  // namespace fw::linalg
