#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/status.hpp"
#include "core/types.hpp"

namespace fw::linalg {

/// What a linear solve has achieved.
struct LinearSolve {
  Status status;
  std::uint64_t iterations = 0;    ///< 0 for direct solvers
  double relative_residual = 0.0;  ///< the true ‖b − A x‖₂/‖b‖₂, recomputed from x
};

/// The vectors of conjugate gradients, allocated once per run.
struct ConjugateGradientWorkspace {
  Vector residual, direction, preconditioned, product;
  void resize(Index n) {
    if (residual.size() == n) return;
    residual.resize(n);
    direction.resize(n);
    preconditioned.resize(n);
    product.resize(n);
  }
};

/// Solves A x = b for a symmetric positive definite A by preconditioned conjugate gradients
/// [Hestenes, Stiefel 1952; Zachmann 2011, S26].
///
/// `apply(p, out)` writes A p, `precondition(r, out)` writes an approximation of A⁻¹ r. `x` holds the initial
/// guess. Stops when ‖r‖₂ ≤ tolerance·‖b‖₂ by the recurrence and then checks the true residual. Meets
/// pᵀAp ≤ 0: StatusCode::matrix_indefinite. Not converged in `max_iterations`, or the true residual more than
/// ten times the tolerance: StatusCode::linear_solver_failed.
template <class Apply, class Precondition>
LinearSolve conjugate_gradient(const Apply& apply, const Precondition& precondition, ConstVectorRef b,
                               VectorRef x, double tolerance, std::uint64_t max_iterations,
                               ConjugateGradientWorkspace& work) {
  work.resize(b.size());
  Vector& r = work.residual;
  Vector& p = work.direction;
  Vector& z = work.preconditioned;
  Vector& Ap = work.product;

  LinearSolve result;
  const double b_norm = b.norm();
  if (!std::isfinite(b_norm)) {
    result.status = {StatusCode::non_finite, "the right-hand side of the linear system is not finite"};
    return result;
  }
  if (b_norm == 0.0) {
    x.setZero();
    return result;
  }
  const double target = tolerance * b_norm;
  apply(x, Ap);
  r = b - Ap;
  precondition(r, z);
  p = z;
  double rho = r.dot(z);
  while (r.norm() > target) {
    if (result.iterations == max_iterations) {
      result.relative_residual = r.norm() / b_norm;
      result.status = {StatusCode::linear_solver_failed,
                       fmt::format("conjugate gradients reached {} iterations with relative residual {:.3g}, "
                                   "expected {:.3g}",
                                   max_iterations, result.relative_residual, tolerance)};
      return result;
    }
    apply(p, Ap);
    const double curvature = p.dot(Ap);
    if (!std::isfinite(curvature)) {
      result.status = {StatusCode::non_finite, "conjugate gradients met a value that is not finite"};
      return result;
    }
    if (curvature <= 0.0 || rho <= 0.0) {
      result.relative_residual = r.norm() / b_norm;
      result.status = {StatusCode::matrix_indefinite,
                       fmt::format("conjugate gradients met p'Ap = {:.3g} at iteration {}: the matrix is not "
                                   "positive definite",
                                   curvature, result.iterations)};
      return result;
    }
    const double alpha = rho / curvature;
    x += alpha * p;
    r -= alpha * Ap;
    precondition(r, z);
    const double rho_next = r.dot(z);
    p = z + (rho_next / rho) * p;
    rho = rho_next;
    ++result.iterations;
  }
  apply(x, Ap);
  result.relative_residual = (b - Ap).norm() / b_norm;
  // Rounding lets the true residual stay above a tolerance near machine precision; more than that is a
  // failure.
  const double rounding = 1e-13;
  if (!(result.relative_residual <= std::max(10.0 * tolerance, rounding))) {
    result.status = {
        StatusCode::linear_solver_failed,
        fmt::format("the true residual {:.3g} of conjugate gradients is above the tolerance {:.3g}",
                    result.relative_residual, tolerance)};
  }
  return result;
}

}  // namespace fw::linalg
