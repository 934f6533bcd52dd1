#include "study/linear_solver/step_systems.hpp"

#include "core/error.hpp"

namespace fw::study {

namespace {

const SecondOrderSystem& second_order_of(const Ivp& ivp) {
  const SecondOrderSystem* system = ivp.system->second_order();
  if (system == nullptr) {
    throw InputError(
        "the linear systems of an implicit step need M q'' = f(t, q, q'), the problem is y' = f(t, y)");
  }
  return *system;
}

}  // namespace

StepSystems::StepSystems(const Ivp& ivp, double step)
    : owner_(ivp.system),
      system_(second_order_of(ivp)),
      step_(step),
      time_(ivp.t0),
      state_(ivp.y0),
      assembly_(system_),
      direct_(linalg::make_linear_solver({.kind = linalg::LinearSolverKind::cholmod})),
      right_hand_side_(system_.degrees_of_freedom()),
      product_(system_.degrees_of_freedom()),
      zero_(Vector::Zero(system_.degrees_of_freedom())) {
  assemble();
}

void StepSystems::assemble() {
  const Index n = right_hand_side_.size();
  const auto x = state_.head(n), v = state_.tail(n);
  const double t = time_ + step_;
  const TangentModel model = system_.has_springs() ? TangentModel::psd_projection : TangentModel::exact;
  matrix_ = &assembly_.assemble_symmetric(t, x, v, step_, model);
  system_.force(t, x, v, right_hand_side_);
  system_.tangent_product(t, x, v, v, zero_, product_);
  right_hand_side_ = step_ * (right_hand_side_ + step_ * product_);
}

linalg::LinearSolve StepSystems::solve_directly(Vector& solution) {
  solution.resize(right_hand_side_.size());
  linalg::LinearSolve solve;
  solve.status = direct_->factorise(*matrix_, work_);
  return solve.status.ok() ? direct_->solve(right_hand_side_, solution, work_) : solve;
}

Status StepSystems::advance() {
  Vector increment;
  if (linalg::LinearSolve solve = solve_directly(increment); !solve.status.ok()) return solve.status;
  const Index n = increment.size();
  state_.tail(n) += increment;
  state_.head(n) += step_ * state_.tail(n);
  time_ += step_;
  assemble();
  return {};
}

}  // namespace fw::study
