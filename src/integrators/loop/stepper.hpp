#pragma once

#include <functional>
#include <memory>

#include "core/state_archive.hpp"
#include "ode/integrator.hpp"

namespace fw::integrators {

/// The state of a run of a hand-written scheme: makes one step at a time.
class Stepper {
 public:
  virtual ~Stepper() = default;

  /// Advances y from t to t + h in place. On failure y is undefined.
  virtual Status step(double t, double h, VectorRef y) = 0;

  /// The state is y at t, which no step has led to: forgets slopes, differences, histories, guesses and
  /// factorised matrices of the old one. The steps that follow are those of a new stepper from (t, y), bit
  /// for bit.
  virtual void restart(double t, ConstVectorRef y) = 0;

  /// Visits every member that a later step reads before it writes it. A new stepper of the same method,
  /// problem and step that has loaded them goes on bit for bit. Throws InputError where it cannot be saved.
  virtual void serialise(StateArchive& archive) = 0;
};

/// A stepper that estimates its error, so that its steps can be chosen.
class AdaptiveStepper : public Stepper {
 public:
  /// Tries the step from (t, y) to t + h: writes the solution that is propagated (the higher-order one) into
  /// `y_new` and its difference from the embedded one into `error`. May be called again from the same (t, y)
  /// with a smaller h. A failure that a smaller step may cure (Newton, a value that is not finite) is a Status
  /// as well.
  virtual Status attempt(double t, double h, ConstVectorRef y, VectorRef y_new, VectorRef error) = 0;

  /// The last attempt has become the state: what it knows of the end (FSAL) serves the next step.
  virtual void accept() = 0;
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

  /// The state of a run of its own with steps `h`, for a look at single steps.
  std::unique_ptr<Stepper> make_stepper(const Ivp& ivp, double h, Work& work) const {
    return make_stepper_(ivp, h, work);
  }

 private:
  Solution do_solve(const Ivp& ivp, const StepControl& control, Observer& observer,
                    const SolveOptions& options) const override;

  MethodInfo info_;
  StepperFactory make_stepper_;
  ExtendedSolver extended_solver_;
};

/// How the interval divides into constant steps for this method: one that carries a history takes no shorter
/// last step. Throws InputError as `count_steps` does.
StepCount count_steps_of(const MethodInfo& info, const Ivp& ivp, const FixedStep& control);

/// Every step of `control` with the stepper that `make_stepper` makes, t_n = t₀ + n·h. Inside a step the
/// observer can interpolate as `info.dense_output` says; what that evaluates `Work` counts.
Solution run_fixed_steps(const MethodInfo& info, const StepperFactory& make_stepper, const Ivp& ivp,
                         const FixedStep& control, Observer& observer, const SolveOptions& options);

}  // namespace fw::integrators
