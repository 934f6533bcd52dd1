#include "oracles/foreign_stepper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "integrators/loop/hermite_interpolant.hpp"
#include "integrators/loop/run_checks.hpp"

namespace fw::oracles {

namespace {

/// Some libraries only warn of steps below the rounding of t and would go on with them for ever.
constexpr int most_steps_without_progress = 20;

/// Where the steps have to end: at each multiple of the constant step, or at the end time only.
class StepLimits {
 public:
  StepLimits(const MethodInfo& info, const Ivp& ivp, const StepControl& control)
      : start_(ivp.t0), end_(ivp.t1) {
    if (const auto* fixed = std::get_if<FixedStep>(&control)) {
      step_ = fixed->step;
      total_ = (fixed->allow_short_last_step && !info.is_multistep
                    ? count_steps(ivp.t0, ivp.t1, step_)
                    : count_whole_steps(info.name, ivp.t0, ivp.t1, step_))
                   .total();
    }
  }

  bool are_of_constant_steps() const { return step_ != 0.0; }

  double of_step(std::uint64_t n) const {
    return step_ == 0.0 || n >= total_ ? end_ : start_ + static_cast<double>(n) * step_;
  }

 private:
  double start_, end_;
  double step_ = 0.0;  ///< 0: the solver chooses
  std::uint64_t total_ = 0;
};

StepControl checked(const MethodInfo& info, const ToleranceScaling& scaling, const StepControl& control) {
  if (std::holds_alternative<FixedStep>(control)) {
    if (!info.has_fixed_step) {
      throw InputError(
          fmt::format("method \"{}\" chooses its own steps: give tolerances, not a step", info.name));
    }
    return control;
  }
  if (!info.is_adaptive) {
    throw InputError(fmt::format("method \"{}\" has a fixed step: give a step, not tolerances", info.name));
  }
  AdaptiveStep tolerances = std::get<AdaptiveStep>(control);
  check_tolerances(info.name, tolerances);
  tolerances.relative_tolerance =
      std::min(tolerances.relative_tolerance,
               std::max(tolerances.relative_tolerance * scaling.factor, scaling.smallest_relative));
  tolerances.absolute_tolerance *= scaling.factor;
  return tolerances;
}

/// Advances to the end; time and state of `solution` are the last good ones.
Status run(const StepLimits& limits, std::uint64_t maximum_steps, const Ivp& ivp, ForeignStepper& stepper,
           Observer& observer, Solution& solution) {
  integrators::HermiteInterpolant hermite(*ivp.system, solution.work);
  const std::function<void(double, VectorRef)> interpolate = [&](double t, VectorRef out) {
    if (stepper.has_dense_output()) {
      stepper.interpolate(t, out);
    } else {
      hermite(t, out);
    }
  };
  Vector y = ivp.y0;
  double t = ivp.t0;
  int steps_without_progress = 0;
  for (std::uint64_t n = 1;; ++n) {
    if (n > maximum_steps) {
      return {StatusCode::step_limit,
              fmt::format("{} steps did not reach the end: stopped at t = {:.6g}", n - 1, t)};
    }
    const double t_before = t;
    if (Status status = stepper.advance(limits.of_step(n), t, y); !status.ok()) return status;
    if (limits.are_of_constant_steps() &&
        std::abs(t - limits.of_step(n)) > 1e-6 * std::abs(limits.of_step(n) - t_before)) {
      return {StatusCode::library_failure,
              fmt::format("at t = {:.6g} the library stepped to {:.17g} instead of {:.17g}", t_before, t,
                          limits.of_step(n))};
    }
    if (Status status = integrators::check_state(y, t, n); !status.ok()) return status;
    steps_without_progress = t > t_before ? 0 : steps_without_progress + 1;
    if (steps_without_progress == most_steps_without_progress) {
      return {StatusCode::step_too_small,
              fmt::format("at t = {:.6g} the step fell below the rounding of t", t)};
    }
    ++solution.work.accepted_steps;
    const bool last = t >= ivp.t1;
    if (last) t = ivp.t1;
    hermite.set_step(t_before, t, solution.state, y);
    const bool go_on = observer.observe({n, t, y, last, interpolate});
    solution.time = t;
    solution.state = y;
    if (last) return {};
    if (!go_on) return {StatusCode::stopped_by_observer, fmt::format("stopped at t = {:.6g}", t)};
  }
}

}  // namespace

Solution OracleIntegrator::do_solve(const Ivp& ivp, const StepControl& control, Observer& observer) const {
  const StepControl given_to_library = checked(info_, scaling_, control);
  const StepLimits limits(info_, ivp, control);
  const auto* tolerances = std::get_if<AdaptiveStep>(&control);
  const std::function<void(double, VectorRef)> nothing_yet;
  Solution solution;
  solution.time = ivp.t0;
  solution.state = ivp.y0;
  if (!observer.observe({0, ivp.t0, ivp.y0, false, nothing_yet})) {
    solution.status = {StatusCode::stopped_by_observer, "stopped at the start"};
    return solution;
  }
  const std::unique_ptr<ForeignStepper> stepper = make_stepper_(ivp, given_to_library, solution.work);
  const std::uint64_t maximum_steps =
      tolerances != nullptr ? tolerances->maximum_steps : std::numeric_limits<std::uint64_t>::max();
  solution.status = run(limits, maximum_steps, ivp, *stepper, observer, solution);
  stepper->collect_work(solution.work);
  return solution;
}

}  // namespace fw::oracles
