#include "linalg/newton.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fw::linalg {

namespace {

constexpr int max_iterations = 50;
constexpr int max_halvings = 12;
constexpr double relative_tolerance = 1e-12;
constexpr double rounding_floor = 1e-8;

}  // namespace

Newton::Newton(Index size, std::unique_ptr<LinearSolver> solver)
    : solver_(std::move(solver)), residual_(size), correction_(size), trial_(size) {}

Status Newton::solve(NewtonProblem& problem, VectorRef u, double scale, Work& work) {
  problem.residual(u, residual_);
  double residual_norm = residual_.norm();
  double previous = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    if (!std::isfinite(residual_norm))
      return {StatusCode::non_finite, "the residual of Newton's iteration is not finite"};
    if (residual_norm == 0.0) return {};
    if (Status status = solver_->factorise(problem.matrix(u), work); !status.ok()) return status;
    correction_.setZero();  // the guess of an iterative solver
    if (LinearSolve solve = solver_->solve(residual_, correction_, work); !solve.status.ok())
      return solve.status;
    ++work.newton_iterations;

    const double size = correction_.lpNorm<Eigen::Infinity>();
    const double reference = std::max(u.lpNorm<Eigen::Infinity>(), scale);
    const bool converged = size <= relative_tolerance * reference ||
                           (size >= 0.5 * previous && size <= rounding_floor * reference);
    double length = 1.0;
    for (int halving = 0;; ++halving) {
      trial_ = u - length * correction_;
      problem.residual(trial_, residual_);
      const double trial_norm = residual_.norm();
      if (converged || trial_norm < residual_norm || halving == max_halvings) {
        residual_norm = trial_norm;
        break;
      }
      // Near the solution rounding can keep the residual from falling.
      if (size <= rounding_floor * reference) {
        residual_norm = trial_norm;
        break;
      }
      length *= 0.5;
    }
    u = trial_;
    if (converged) return {};
    previous = size;
  }
  return {StatusCode::newton_failed,
          fmt::format("Newton's iteration did not converge in {} iterations (residual {:.3g})",
                      max_iterations, residual_norm)};
}

}  // namespace fw::linalg
