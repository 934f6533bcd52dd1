#include "integrators/loop/limited_integrator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/error.hpp"

namespace fw::integrators {

namespace {

class LimitedIntegrator final : public Integrator {
 public:
  LimitedIntegrator(std::unique_ptr<Integrator> method, double maximum_step)
      : method_(std::move(method)), maximum_step_(maximum_step) {}

  const MethodInfo& info() const override { return method_->info(); }
  const ExtendedSolver& extended_solver() const override { return method_->extended_solver(); }

 private:
  Solution do_solve(const Ivp& ivp, const StepControl& control, Observer& observer,
                    const SolveOptions& options) const override {
    StepControl limited = control;
    if (auto* adaptive = std::get_if<AdaptiveStep>(&limited)) {
      adaptive->maximum_step = std::min(adaptive->maximum_step, maximum_step_);
      adaptive->initial_step = std::min(adaptive->initial_step, maximum_step_);
    }
    return method_->solve(ivp, limited, observer, options);
  }

  std::unique_ptr<Integrator> method_;
  double maximum_step_;
};

}  // namespace

std::unique_ptr<Integrator> make_limited(std::unique_ptr<Integrator> method, double maximum_step) {
  if (!method->info().is_adaptive) {
    throw InputError("maximum_step: the method has a fixed step, expected one that chooses its steps");
  }
  if (!(maximum_step > 0.0)) {
    throw InputError(fmt::format("maximum_step: found {}, expected a number of seconds > 0", maximum_step));
  }
  return std::make_unique<LimitedIntegrator>(std::move(method), maximum_step);
}

}  // namespace fw::integrators
