#pragma once

#include <functional>
#include <memory>
#include <string>

#include "integrators/loop/step_size_controller.hpp"
#include "integrators/loop/stepper.hpp"

namespace fw::integrators {

/// Makes the state of a run with variable steps.
using AdaptiveStepperFactory = std::function<std::unique_ptr<AdaptiveStepper>(const Ivp& ivp, Work& work)>;

/// A hand-written scheme with an error estimate: runs with a constant step as well as with steps chosen by
/// tolerances.
class AdaptiveIntegrator final : public Integrator {
 public:
  /// Sets `info.dense_output`: polynomials through side steps for explicit schemes of an order above 3, cubic
  /// Hermite polynomials for other explicit ones, side steps for implicit ones.
  AdaptiveIntegrator(MethodInfo info, ControllerOptions options, AdaptiveStepperFactory make_stepper,
                     ExtendedSolver extended_solver = {});

  const MethodInfo& info() const override { return info_; }
  const ExtendedSolver& extended_solver() const override { return extended_solver_; }

  /// The state of a run of its own, for a look at single steps and their error estimates.
  std::unique_ptr<AdaptiveStepper> make_stepper(const Ivp& ivp, Work& work) const {
    return make_stepper_(ivp, work);
  }

 private:
  Solution do_solve(const Ivp& ivp, const StepControl& control, Observer& observer,
                    const SolveOptions& options) const override;

  MethodInfo info_;
  ControllerOptions options_;
  AdaptiveStepperFactory make_stepper_;
  ExtendedSolver extended_solver_;
};

}  // namespace fw::integrators
