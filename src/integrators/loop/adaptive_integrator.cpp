#include "integrators/loop/adaptive_integrator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "integrators/loop/hermite_interpolant.hpp"
#include "integrators/loop/initial_step.hpp"
#include "integrators/loop/run_checks.hpp"

namespace fw::integrators {

namespace {

/// The largest relative distance from the end that is taken in one step instead of leaving a sliver.
constexpr double stretch_to_end = 1.01;
/// Steps below this many units in the last place of t do not advance it reliably.
constexpr double smallest_step_in_ulps = 16.0;
constexpr int most_failures_in_a_row = 100;

/// One run with steps chosen by the error estimate.
class AdaptiveRun {
 public:
  AdaptiveRun(const MethodInfo& info, const ControllerOptions& options, const Ivp& ivp,
              const AdaptiveStep& control, Observer& observer)
      : info_(info),
        options_(options),
        ivp_(ivp),
        control_(control),
        observer_(observer),
        controller_(options, std::min(info.order, info.embedded_order) + 1) {}

  Solution run(const AdaptiveStepperFactory& make_stepper) {
    solution_.time = ivp_.t0;
    solution_.state = ivp_.y0;
    const std::function<void(double, VectorRef)> nothing_yet;
    if (!observer_.observe({0, ivp_.t0, ivp_.y0, false, nothing_yet})) {
      solution_.status = {StatusCode::stopped_by_observer, "stopped at the start"};
      return std::move(solution_);
    }
    const std::unique_ptr<AdaptiveStepper> stepper = make_stepper(ivp_, solution_.work);
    solution_.status = advance(*stepper);
    return std::move(solution_);
  }

 private:
  Status advance(AdaptiveStepper& stepper) {
    Vector y_new(ivp_.y0.size()), error(ivp_.y0.size());
    HermiteInterpolant hermite(*ivp_.system, solution_.work);
    double step_start = ivp_.t0, step_end = ivp_.t0;
    const std::function<void(double, VectorRef)> interpolate = [&](double t, VectorRef out) {
      if (stepper.has_dense_output()) {
        stepper.interpolate((t - step_start) / (step_end - step_start), out);
      } else {
        hermite(t, out);
      }
    };
    double& t = solution_.time;
    Vector& y = solution_.state;
    double h = control_.initial_step > 0.0
                   ? std::min({control_.initial_step, control_.maximum_step, ivp_.t1 - ivp_.t0})
                   : std::max(initial_step(ivp_, control_, options_.norm, info_.order, solution_.work),
                              control_.minimum_step);
    int failures = 0;
    for (std::uint64_t steps = 0;;) {
      const double rest = ivp_.t1 - t;
      const bool last = h * stretch_to_end >= rest && rest <= control_.maximum_step;
      const double smallest = std::max(
          control_.minimum_step, smallest_step_in_ulps * (std::nextafter(std::abs(t), 1e300) - std::abs(t)));
      if (!last && h < smallest) {
        return {StatusCode::step_too_small,
                fmt::format(
                    "at t = {:.6g} the error test asks for a step of {:.3g}, below the smallest of {:.3g}{}",
                    t, h, smallest, last_failure_.empty() ? "" : "; last failure: " + last_failure_)};
      }
      if (last) {
        h = rest;
      } else if (2.0 * h > rest) {
        h = std::max(0.5 * rest, smallest);  // two even steps instead of a long and a short one
      }
      if (steps + solution_.work.rejected_steps >= control_.maximum_steps) {
        return {StatusCode::step_limit, fmt::format("{} steps did not reach the end: stopped at t = {:.6g}",
                                                    control_.maximum_steps, t)};
      }
      const double estimate = try_step(stepper, t, h, y, y_new, error);
      if (!(estimate <= 1.0)) {
        ++solution_.work.rejected_steps;
        if (++failures > most_failures_in_a_row) {
          return {StatusCode::step_too_small,
                  fmt::format("at t = {:.6g} the step failed {} times in a row{}", t, failures,
                              last_failure_.empty() ? "" : "; last failure: " + last_failure_)};
        }
        h *= controller_.after_rejection(estimate);
        continue;
      }
      failures = 0;
      last_failure_.clear();
      ++steps;
      if (Status status = check_state(y_new, t + h, steps); !status.ok()) return status;
      stepper.accept();
      ++solution_.work.accepted_steps;
      step_start = t;
      step_end = last ? ivp_.t1 : t + h;
      if (!stepper.has_dense_output()) hermite.set_step(step_start, step_end, y, y_new);
      const bool go_on = observer_.observe({steps, step_end, y_new, last, interpolate});
      t = step_end;
      y.swap(y_new);
      if (last) return {};
      if (!go_on) return {StatusCode::stopped_by_observer, fmt::format("stopped at t = {:.6g}", t)};
      h = std::min(h * controller_.after_acceptance(estimate), control_.maximum_step);
    }
  }

  /// The error in units of the tolerance; NaN where the step could not be made.
  double try_step(AdaptiveStepper& stepper, double t, double h, ConstVectorRef y, VectorRef y_new,
                  VectorRef error) {
    const Status status = stepper.attempt(t, h, y, y_new, error);
    if (!status.ok()) {
      last_failure_ = status.describe();
      return std::numeric_limits<double>::quiet_NaN();
    }
    const double estimate = error_in_tolerances(options_.norm, control_, error, y, y_new);
    if (!std::isfinite(estimate)) last_failure_ = "the error estimate is not finite";
    return estimate;
  }

  const MethodInfo& info_;
  const ControllerOptions& options_;
  const Ivp& ivp_;
  const AdaptiveStep& control_;
  Observer& observer_;
  StepSizeController controller_;
  Solution solution_;
  std::string last_failure_;
};

}  // namespace

Solution AdaptiveIntegrator::do_solve(const Ivp& ivp, const StepControl& control, Observer& observer) const {
  if (const auto* fixed = std::get_if<FixedStep>(&control)) {
    return run_fixed_steps(
        info_,
        [this](const Ivp& problem, double, Work& work) -> std::unique_ptr<Stepper> {
          return make_stepper_(problem, work);
        },
        ivp, *fixed, observer);
  }
  const auto& adaptive = std::get<AdaptiveStep>(control);
  check_tolerances(info_.name, adaptive);
  return AdaptiveRun(info_, options_, ivp, adaptive, observer).run(make_stepper_);
}

}  // namespace fw::integrators
