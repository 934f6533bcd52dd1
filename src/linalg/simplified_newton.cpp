#include "linalg/simplified_newton.hpp"

#include <algorithm>
#include <cmath>

namespace fw::linalg {

namespace {

constexpr int max_iterations = 25;
/// Corrections that have stopped falling below this fraction of the scale are rounding.
constexpr double stagnation_level = 1e-9;
constexpr double divergence_rate = 0.9;

}  // namespace

SimplifiedNewton::SimplifiedNewton(Index size, const SimplifiedNewtonOptions& options)
    : options_(options),
      solver_(options.make_solver()),
      damped_(size, options.make_solver()),
      residual_(size),
      correction_(size),
      start_(size) {}

Status SimplifiedNewton::renew(NewtonProblem& problem, ConstVectorRef u, double parameter, Work& work) {
  has_matrix_ = false;
  if (Status status = solver_->factorise(problem.matrix(u), work); !status.ok()) return status;
  parameter_ = parameter;
  revision_ = problem.pattern_revision();
  has_matrix_ = true;
  is_slow_ = false;
  return {};
}

SimplifiedNewton::Outcome SimplifiedNewton::iterate(NewtonProblem& problem, VectorRef u, double scale,
                                                    double floor, Work& work) {
  double previous = 0.0;
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    problem.residual(u, residual_);
    if (!residual_.allFinite()) return Outcome::diverged;
    if (LinearSolve solve = solver_->solve(residual_, correction_, work); !solve.status.ok()) {
      failure_ = std::move(solve.status);
      return Outcome::failed;
    }
    ++work.newton_iterations;
    u -= correction_;
    const double size = correction_.lpNorm<Eigen::Infinity>();
    const double reference = std::max(u.lpNorm<Eigen::Infinity>(), scale);
    bool converged = size == 0.0;
    if (iteration > 0 && !converged) {
      const double rate = size / previous;
      const bool is_rounding = size <= std::max(stagnation_level * reference, floor);
      converged = (rate < 1.0 && rate / (1.0 - rate) * size <= options_.tolerance * reference) ||
                  (rate >= 0.5 && is_rounding);
      if (!converged && rate >= divergence_rate) return Outcome::diverged;
      // The rate of corrections that are rounding says nothing of the matrix.
      if (rate > options_.rate_of_renewal && !is_rounding) is_slow_ = true;
    }
    if (converged) {
      problem.residual(u, residual_);
      return Outcome::converged;
    }
    previous = size;
  }
  return Outcome::diverged;
}

Status SimplifiedNewton::solve(NewtonProblem& problem, VectorRef u, double parameter, double scale,
                               double floor, Work& work) {
  start_ = u;
  const bool is_reused = has_matrix_ && parameter == parameter_ && revision_ == problem.pattern_revision() &&
                         !is_slow_ && options_.rate_of_renewal > 0.0;
  if (!is_reused) {
    if (Status status = renew(problem, u, parameter, work); !status.ok()) return status;
  }
  Outcome outcome = iterate(problem, u, scale, floor, work);
  if (outcome == Outcome::diverged && is_reused) {
    u = start_;
    if (Status status = renew(problem, u, parameter, work); !status.ok()) return status;
    outcome = iterate(problem, u, scale, floor, work);
  }
  if (outcome == Outcome::failed) return failure_;
  if (outcome == Outcome::diverged) {
    has_matrix_ = false;
    u = start_;
    return damped_.solve(problem, u, scale, work);
  }
  return {};
}

void SimplifiedNewton::forget_matrix() {
  has_matrix_ = false;
  is_slow_ = false;
  solver_->forget();
  damped_.forget_matrix();
}

void SimplifiedNewton::serialise(StateArchive& archive) {
  archive.visit("parameter of the matrix", parameter_);
  archive.visit("has a matrix", has_matrix_);
  archive.visit("converges slowly", is_slow_);
  solver_->serialise(archive);
  damped_.serialise(archive);
}

Status SimplifiedNewton::solve_linear(ConstVectorRef b, VectorRef x, Work& work) {
  return solver_->solve(b, x, work).status;
}

}  // namespace fw::linalg
