#pragma once

#include <functional>
#include <memory>

#include "conformance/altered_system.hpp"
#include "integrators/loop/adaptive_integrator.hpp"

namespace fw::conformance {

/// Runs another scheme's solve under claims of its own.
class ClaimingIntegrator final : public Integrator {
 public:
  using Solve = std::function<Solution(const Ivp&, const StepControl&, Observer&)>;

  ClaimingIntegrator(MethodInfo claims, ExtendedSolver extended_solver, Solve solve)
      : claims_(std::move(claims)), extended_solver_(std::move(extended_solver)), solve_(std::move(solve)) {}

  const MethodInfo& info() const override { return claims_; }
  const ExtendedSolver& extended_solver() const override { return extended_solver_; }

 private:
  Solution do_solve(const Ivp& ivp, const StepControl& control, Observer& observer,
                    const SolveOptions&) const override {
    return solve_(ivp, control, observer);
  }

  MethodInfo claims_;
  ExtendedSolver extended_solver_;
  Solve solve_;
};

/// The running code of `mutant` under the claims of the right scheme. What can choose its steps stays able
/// to.
inline std::unique_ptr<Integrator> with_claims(const MethodInfo& claims, std::unique_ptr<Integrator> mutant) {
  const std::shared_ptr<const Integrator> code = std::move(mutant);
  if (const auto adaptive = std::dynamic_pointer_cast<const integrators::AdaptiveIntegrator>(code)) {
    return std::make_unique<integrators::AdaptiveIntegrator>(
        claims, integrators::ControllerOptions{},
        [adaptive](const Ivp& ivp, Work& work) { return adaptive->make_stepper(ivp, work); },
        adaptive->extended_solver());
  }
  return std::make_unique<ClaimingIntegrator>(
      claims, code->extended_solver(),
      [code](const Ivp& ivp, const StepControl& control, Observer& observer) {
        return code->solve(ivp, control, observer);
      });
}

/// `right` on a system that answers wrongly; the alteration may depend on the constant step.
inline std::unique_ptr<Integrator> on_altered_system(
    std::unique_ptr<Integrator> right, const std::function<Alteration(const Ivp&, double step)>& alter) {
  const std::shared_ptr<const Integrator> code = std::move(right);
  return std::make_unique<ClaimingIntegrator>(
      code->info(), code->extended_solver(),
      [code, alter](const Ivp& ivp, const StepControl& control, Observer& observer) {
        const auto* fixed = std::get_if<FixedStep>(&control);
        Ivp altered = ivp;
        altered.system =
            std::make_shared<AlteredSystem>(ivp.system, alter(ivp, fixed == nullptr ? 0.0 : fixed->step));
        return code->solve(altered, control, observer);
      });
}

/// A right stepper that hands every result of an attempt through `spoil(h, y_new, error)`.
class SpoiledStepper final : public integrators::AdaptiveStepper {
 public:
  using Spoil = std::function<void(double h, ConstVectorRef y, VectorRef y_new, VectorRef error)>;

  SpoiledStepper(std::unique_ptr<integrators::AdaptiveStepper> stepper, Spoil spoil)
      : stepper_(std::move(stepper)), spoil_(std::move(spoil)) {}

  Status step(double t, double h, VectorRef y) override { return stepper_->step(t, h, y); }
  Status attempt(double t, double h, ConstVectorRef y, VectorRef y_new, VectorRef error) override {
    Status status = stepper_->attempt(t, h, y, y_new, error);
    spoil_(h, y, y_new, error);
    return status;
  }
  void accept() override { stepper_->accept(); }
  void restart(double t, ConstVectorRef y) override { stepper_->restart(t, y); }
  void serialise(StateArchive& archive) override { stepper_->serialise(archive); }

 private:
  std::unique_ptr<integrators::AdaptiveStepper> stepper_;
  Spoil spoil_;
};

/// An adaptive scheme whose attempts are spoiled.
inline std::unique_ptr<Integrator> with_spoiled_attempts(std::unique_ptr<Integrator> right,
                                                         SpoiledStepper::Spoil spoil) {
  const std::shared_ptr<const integrators::AdaptiveIntegrator> code(
      dynamic_cast<const integrators::AdaptiveIntegrator*>(right.release()));
  return std::make_unique<integrators::AdaptiveIntegrator>(
      code->info(), integrators::ControllerOptions{},
      [code, spoil](const Ivp& ivp, Work& work) -> std::unique_ptr<integrators::AdaptiveStepper> {
        return std::make_unique<SpoiledStepper>(code->make_stepper(ivp, work), spoil);
      },
      code->extended_solver());
}

}  // namespace fw::conformance
