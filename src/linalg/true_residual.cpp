#include "linalg/true_residual.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fw::linalg {

Status non_finite_matrix() {
  return {StatusCode::non_finite, "the matrix of the linear system is not finite"};
}

LinearSolve judge_solution(const SparseMatrix& A, ConstVectorRef b, ConstVectorRef x, double tolerance,
                           Vector& residual) {
  LinearSolve result;
  const double b_norm = b.norm();
  if (!std::isfinite(b_norm)) {
    result.status = {StatusCode::non_finite, "the right-hand side of the linear system is not finite"};
    return result;
  }
  residual = b;
  residual.noalias() -= A * x;
  result.relative_residual = b_norm > 0.0 ? residual.norm() / b_norm : residual.norm();
  const double rounding = 1e-13;
  if (!std::isfinite(result.relative_residual)) {
    result.status = {StatusCode::non_finite, "the solution of the linear system is not finite"};
  } else if (result.relative_residual > std::max(tolerance, rounding)) {
    result.status = {StatusCode::linear_solver_failed,
                     fmt::format("the true relative residual is {:.3g}, expected at most {:.3g}",
                                 result.relative_residual, tolerance)};
  }
  return result;
}

}  // namespace fw::linalg
