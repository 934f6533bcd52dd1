#include "integrators/loop/stepper.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "integrators/loop/hermite_interpolant.hpp"
#include "integrators/loop/run_checks.hpp"

namespace fw::integrators {

Solution run_fixed_steps(const MethodInfo& info, const StepperFactory& make_stepper, const Ivp& ivp,
                         const FixedStep& control, Observer& observer) {
  const double h = control.step;
  const StepCount count = control.allow_short_last_step && !info.is_multistep
                              ? count_steps(ivp.t0, ivp.t1, h)
                              : count_whole_steps(info.name, ivp.t0, ivp.t1, h);
  const std::function<void(double, VectorRef)> nothing_yet;
  Solution solution;
  solution.time = ivp.t0;
  solution.state = ivp.y0;
  if (!observer.observe({0, ivp.t0, ivp.y0, false, nothing_yet})) {
    solution.status = {StatusCode::stopped_by_observer, "stopped at the start"};
    return solution;
  }
  const std::unique_ptr<Stepper> stepper = make_stepper(ivp, h, solution.work);
  Vector y = ivp.y0;
  HermiteInterpolant hermite(*ivp.system, solution.work);
  auto* own_interpolant = dynamic_cast<AdaptiveStepper*>(stepper.get());
  if (own_interpolant != nullptr && !own_interpolant->has_dense_output()) own_interpolant = nullptr;
  double step_start = ivp.t0, step_length = h;
  const std::function<void(double, VectorRef)> interpolate = [&](double t, VectorRef out) {
    if (own_interpolant != nullptr) {
      own_interpolant->interpolate((t - step_start) / step_length, out);
    } else {
      hermite(t, out);
    }
  };
  const std::uint64_t total = count.total();
  for (std::uint64_t n = 0; n < total; ++n) {
    const double t = ivp.t0 + static_cast<double>(n) * h;
    const bool last = n + 1 == total;
    const double length = n < count.whole ? h : count.remainder;
    const double t_next = last ? ivp.t1 : ivp.t0 + static_cast<double>(n + 1) * h;
    Status status = stepper->step(t, length, y);
    if (status.ok()) {
      status = check_state(y, t_next, n + 1);
    } else {
      status.message = fmt::format("step {} at t = {:.6g}: {}", n + 1, t, status.message);
    }
    if (!status.ok()) {
      solution.status = std::move(status);
      return solution;
    }
    ++solution.work.accepted_steps;
    hermite.set_step(t, t_next, solution.state, y);
    step_start = t;
    step_length = length;
    const bool go_on = observer.observe({n + 1, t_next, y, last, interpolate});
    solution.time = t_next;
    solution.state = y;
    if (!go_on && !last) {
      solution.status = {StatusCode::stopped_by_observer, fmt::format("stopped at t = {:.6g}", t_next)};
      return solution;
    }
  }
  return solution;
}

Solution FixedStepIntegrator::do_solve(const Ivp& ivp, const StepControl& control, Observer& observer) const {
  const auto* fixed = std::get_if<FixedStep>(&control);
  if (fixed == nullptr) {
    throw InputError(fmt::format("method \"{}\" has a fixed step: give a step, not tolerances", info_.name));
  }
  return run_fixed_steps(info_, make_stepper_, ivp, *fixed, observer);
}

}  // namespace fw::integrators
