#pragma once

#include "linalg/linear_solver.hpp"

namespace fw::linalg {

/// The relative residual above which a backward stable direct solve has gone wrong.
inline constexpr double largest_direct_residual = 1e-6;

/// The Status of a matrix with an entry that is not finite.
Status non_finite_matrix();

/// Recomputes ‖b − A x‖₂/‖b‖₂ from A, b and x and judges it: non_finite, or linear_solver_failed where it is
/// above `tolerance` and above rounding. `residual` is work space. `iterations` is left to the caller.
LinearSolve judge_solution(const SparseMatrix& A, ConstVectorRef b, ConstVectorRef x, double tolerance,
                           Vector& residual);

}  // namespace fw::linalg
