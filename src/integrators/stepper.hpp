#pragma once

#include <functional>
#include <memory>

#include "ode/integrator.hpp"

namespace fw::integrators {

/// The state of a run of a hand-written scheme: makes one step at a time.
class Stepper {
 public:
  virtual ~Stepper() = default;

  /// Advances y from t to t + h in place. On failure y is undefined.
  virtual Status step(double t, double h, VectorRef y) = 0;
};

/// Makes the state of a run: allocates all work space and evaluates what the first step needs. `h` is the
/// (constant) step; `work` outlives the stepper and is counted into.
using StepperFactory = std::function<std::unique_ptr<Stepper>(const Ivp& ivp, double h, Work& work)>;

/// A hand-written scheme with constant steps: the shared time loop around a stepper.
class FixedStepIntegrator final : public Integrator {
 public:
  FixedStepIntegrator(MethodInfo info, StepperFactory make_stepper)
      : info_(std::move(info)), make_stepper_(std::move(make_stepper)) {}

  const MethodInfo& info() const override { return info_; }

 private:
  Solution do_solve(const Ivp& ivp, const StepControl& control, Observer& observer) const override;

  MethodInfo info_;
  StepperFactory make_stepper_;
};

}  // namespace fw::integrators
