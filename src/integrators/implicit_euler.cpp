#include "integrators/implicit_euler.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "integrators/step_matrix.hpp"
#include "integrators/stepper.hpp"
#include "linalg/linear_solver.hpp"
#include "linalg/newton.hpp"

namespace fw::integrators {

namespace {

/// ẏ = f(t, y): unknown y', residual y' − y − h f(t', y'), matrix I − h J.
class FirstOrderStepper final : public Stepper, private linalg::NewtonProblem {
 public:
  FirstOrderStepper(const Ivp& ivp, Work& work)
      : system_(*ivp.system),
        work_(work),
        newton_(ivp.y0.size(), linalg::LinearSolverKind::sparse_lu),
        matrix_(system_.jacobian_pattern()),
        slope_(ivp.y0.size()),
        start_(ivp.y0.size()) {}

  Status step(double t, double h, VectorRef y) override {
    start_ = y;
    time_ = t + h;
    step_ = h;
    return newton_.solve(*this, y, 0.0, work_);
  }

 private:
  void residual(ConstVectorRef y, VectorRef out) override {
    system_.rhs(time_, y, slope_);
    ++work_.rhs_evaluations;
    out = y - start_ - step_ * slope_;
  }
  const SparseMatrix& matrix(ConstVectorRef y) override {
    system_.jacobian(time_, y, matrix_);
    ++work_.jacobian_evaluations;
    matrix_.coeffs() *= -step_;
    add_to_diagonal(matrix_, 1.0);
    return matrix_;
  }

  const OdeSystem& system_;
  Work& work_;
  linalg::Newton newton_;
  SparseMatrix matrix_;
  Vector slope_, start_;
  double time_ = 0.0, step_ = 0.0;
};

/// M v̇ = f(t, x, v): unknown v', residual M (v' − v) − h f(t', x + h v', v'), matrix M − h D − h² K.
class SecondOrderStepper final : public Stepper, private linalg::NewtonProblem {
 public:
  SecondOrderStepper(const Ivp& ivp, Work& work)
      : system_(*ivp.system->second_order()),
        work_(work),
        newton_(system_.degrees_of_freedom(), linalg::LinearSolverKind::sparse_lu),
        matrix_(system_),
        force_(system_.degrees_of_freedom()),
        start_position_(system_.degrees_of_freedom()),
        start_velocity_(system_.degrees_of_freedom()),
        position_(system_.degrees_of_freedom()) {}

  Status step(double t, double h, VectorRef y) override {
    const Index n = force_.size();
    start_position_ = y.head(n);
    start_velocity_ = y.tail(n);
    time_ = t + h;
    step_ = h;
    auto v = y.tail(n);
    Status status = newton_.solve(*this, v, start_velocity_.lpNorm<Eigen::Infinity>(), work_);
    if (!status.ok()) return status;
    // v' = v + h M⁻¹f' with the last force, so that momentum changes by forces only, not by Newton's rest.
    v = start_velocity_ + step_ * force_.cwiseQuotient(system_.mass());
    y.head(n) = start_position_ + h * v;
    return {};
  }

 private:
  void residual(ConstVectorRef v, VectorRef out) override {
    position_ = start_position_ + step_ * v;
    system_.force(time_, position_, v, force_);
    ++work_.rhs_evaluations;
    out = system_.mass().cwiseProduct(v - start_velocity_) - step_ * force_;
  }
  const SparseMatrix& matrix(ConstVectorRef v) override {
    position_ = start_position_ + step_ * v;
    ++work_.jacobian_evaluations;
    return matrix_.assemble(time_, position_, v, step_, TangentModel::exact);
  }

  const SecondOrderSystem& system_;
  Work& work_;
  linalg::Newton newton_;
  StepMatrix matrix_;
  Vector force_, start_position_, start_velocity_, position_;
  double time_ = 0.0, step_ = 0.0;
};

}  // namespace

std::unique_ptr<Integrator> make_implicit_euler() {
  MethodInfo info{.name = "implicit_euler",
                  .title = "Implicit Euler (Newton to convergence)",
                  .family = "implicit",
                  .order = 1,
                  .order_with_velocity_forces = 1,
                  .stages = 1,
                  .is_explicit = false,
                  .is_a_stable = true,
                  .is_l_stable = true,
                  .formula = "y' = y + h f(t+h, y')",
                  .reference = "[Zachmann 2011, S22; Hairer, Wanner 1996, IV.3]"};
  return std::make_unique<FixedStepIntegrator>(
      std::move(info), [](const Ivp& ivp, double, Work& work) -> std::unique_ptr<Stepper> {
        if (ivp.system->second_order() != nullptr) return std::make_unique<SecondOrderStepper>(ivp, work);
        return std::make_unique<FirstOrderStepper>(ivp, work);
      });
}

}  // namespace fw::integrators
