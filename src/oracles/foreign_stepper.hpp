#pragma once

#include <functional>
#include <memory>
#include <string>

#include "ode/integrator.hpp"

namespace fw::oracles {

/// The state of a run inside a foreign solver, which owns its stepping: one call, one step.
class ForeignStepper {
 public:
  virtual ~ForeignStepper() = default;

  /// Advances by one step of the solver's choice that does not go beyond `limit` and writes the time reached
  /// and the state there. With a constant step the loop sets `limit` to the end of the step, and the solver
  /// has to land on it. A failure is a Status with the library's own reason; `t` and `y` then stay or are the
  /// last good ones.
  virtual Status advance(double limit, double& t, VectorRef y) = 0;

  /// y(t) inside the last step by the library's interpolant; called where `MethodInfo::dense_output` is
  /// `DenseOutput::library` only.
  virtual void interpolate(double t, VectorRef out);

  /// The state is y at t, which no step has led to: the library's memory starts anew from it, as a new run
  /// does. What it has counted so far stays counted.
  virtual void restart(double t, ConstVectorRef y) = 0;

  /// Adds what only the library has counted (steps rejected, factorisations, ...) to `work`. Called once, at
  /// the end. Accepted steps are counted by the loop, calls of our functions where they happen.
  virtual void collect_work(Work& work) const = 0;
};

/// Makes the state of a run. `control` has been checked; where it is adaptive its tolerances are already
/// those that the library is to get. `work` and `ivp` outlive the stepper.
using ForeignStepperFactory =
    std::function<std::unique_ptr<ForeignStepper>(const Ivp& ivp, const StepControl& control, Work& work)>;

/// How the tolerances of a run reach the library (decision 0017): multiplied by `factor`, relative ones not
/// below `smallest_relative` unless they were so already.
struct ToleranceScaling {
  double factor = 1.0;
  double smallest_relative = 1e-13;
};

/// A foreign solver behind the interface of our own schemes: checks of the step control are the same for all
/// of them, and the time loop is that of our own schemes. Side steps and side runs inside a step are those of
/// a second solver of the same library, so that the run's own sequence of steps stays what it is. The memory of
/// a library cannot be saved: a run with checkpoints is refused.
class OracleIntegrator final : public Integrator {
 public:
  OracleIntegrator(MethodInfo info, ForeignStepperFactory make_stepper, ToleranceScaling scaling = {})
      : info_(std::move(info)), make_stepper_(std::move(make_stepper)), scaling_(scaling) {}

  const MethodInfo& info() const override { return info_; }
  const ExtendedSolver& extended_solver() const override { return no_extended_solver_; }

 private:
  Solution do_solve(const Ivp& ivp, const StepControl& control, Observer& observer,
                    const SolveOptions& options) const override;

  MethodInfo info_;
  ForeignStepperFactory make_stepper_;
  ToleranceScaling scaling_;
  ExtendedSolver no_extended_solver_;
};

}  // namespace fw::oracles
