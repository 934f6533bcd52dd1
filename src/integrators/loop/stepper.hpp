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

/// A stepper that estimates its error, so that its steps can be chosen.
class AdaptiveStepper : public Stepper {
 public:
  /// Tries the step from (t, y) to t + h: writes the solution of higher standing into `y_new` and its
  /// difference from the embedded one into `error`. May be called again from the same (t, y) with a smaller
  /// h. A failure that a smaller step may cure (Newton, a value that is not finite) is a Status as well.
  virtual Status attempt(double t, double h, ConstVectorRef y, VectorRef y_new, VectorRef error) = 0;

  /// The last attempt has become the state: what it knows of the end (FSAL) serves the next step.
  virtual void accept() = 0;

  /// Whether the scheme has a dense output of its own; without one the loop interpolates by cubic Hermite
  /// polynomials.
  virtual bool has_dense_output() const = 0;

  /// y(t + θh), θ ∈ [0, 1], of the step accepted last.
  virtual void interpolate(double theta, VectorRef out) = 0;
};

/// Makes the state of a run: allocates all work space and evaluates what the first step needs. `h` is the
/// (constant) step; `work` outlives the stepper and is counted into.
using StepperFactory = std::function<std::unique_ptr<Stepper>(const Ivp& ivp, double h, Work& work)>;

/// A hand-written scheme with constant steps: the shared time loop around a stepper.
class FixedStepIntegrator final : public Integrator {
 public:
  FixedStepIntegrator(MethodInfo info, StepperFactory make_stepper, ExtendedSolver extended_solver = {})
      : info_(std::move(info)),
        make_stepper_(std::move(make_stepper)),
        extended_solver_(std::move(extended_solver)) {}

  const MethodInfo& info() const override { return info_; }
  const ExtendedSolver& extended_solver() const override { return extended_solver_; }

 private:
  Solution do_solve(const Ivp& ivp, const StepControl& control, Observer& observer) const override;

  MethodInfo info_;
  StepperFactory make_stepper_;
  ExtendedSolver extended_solver_;
};

/// The shared loop: every step of `control` with the stepper that `make_stepper` makes. Inside a step the
/// observer can interpolate by the stepper's dense output or the cubic Hermite polynomial (slopes at both
/// ends, which `Work` counts).
Solution run_fixed_steps(const MethodInfo& info, const StepperFactory& make_stepper, const Ivp& ivp,
                         const FixedStep& control, Observer& observer);

}  // namespace fw::integrators
