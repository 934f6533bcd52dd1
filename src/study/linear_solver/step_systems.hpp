#pragma once

#include <memory>

#include "integrators/implicit/step_matrix.hpp"
#include "linalg/linear_solver.hpp"
#include "ode/ivp.hpp"

namespace fw::study {

/// The linear systems A δ = b of the linearised implicit Euler method along its own trajectory,
/// A = ½(S + Sᵀ) with S = M − h D − h² K on the moving degrees of freedom and b = h (f + h K v), one step
/// after the other [Zachmann 2011, S26]. Springs under compression enter A without their negative part
/// (TangentModel::psd_projection), so that A is positive definite at every step; systems without springs have
/// the exact one.
class StepSystems {
 public:
  /// At the initial state. Throws InputError where the problem is no M q̈ = f.
  StepSystems(const Ivp& ivp, double step);

  /// Makes A and b anew at the current state; what a simulation pays for at each step.
  void assemble();

  const SparseMatrix& matrix() const { return *matrix_; }
  const Vector& right_hand_side() const { return right_hand_side_; }

  /// Positions of the current state, for solvers that use them.
  auto positions() const { return state_.head(right_hand_side_.size()); }

  /// Solves the current system by CHOLMOD, takes the step and assembles the next system.
  Status advance();

  /// The solution of the current system by CHOLMOD, with its true residual.
  linalg::LinearSolve solve_directly(Vector& solution);

 private:
  std::shared_ptr<const OdeSystem> owner_;
  const SecondOrderSystem& system_;
  double step_, time_;
  Vector state_;
  integrators::StepMatrix assembly_;
  const SparseMatrix* matrix_ = nullptr;
  std::unique_ptr<linalg::LinearSolver> direct_;
  Vector right_hand_side_, product_, zero_;
  Work work_;
};

}  // namespace fw::study
