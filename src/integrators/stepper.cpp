#include "integrators/stepper.hpp"

#include <fmt/format.h>

#include "core/error.hpp"

namespace fw::integrators {

namespace {

/// No physical state comes near this; one that does has left the scheme's region of stability.
constexpr double blow_up_bound = 1e100;

Status check_state(ConstVectorRef y, double t, std::uint64_t step) {
  if (!y.allFinite()) {
    return {StatusCode::non_finite,
            fmt::format("the state is not finite after step {} at t = {:.6g}", step, t)};
  }
  if (y.lpNorm<Eigen::Infinity>() > blow_up_bound) {
    return {StatusCode::blow_up,
            fmt::format("the state exceeds {:g} after step {} at t = {:.6g}", blow_up_bound, step, t)};
  }
  return {};
}

}  // namespace

Solution FixedStepIntegrator::do_solve(const Ivp& ivp, const StepControl& control, Observer& observer) const {
  const auto* fixed = std::get_if<FixedStep>(&control);
  if (fixed == nullptr) {
    throw InputError(fmt::format("method \"{}\" has a fixed step: give a step, not tolerances", info_.name));
  }
  const double h = fixed->step;
  const StepCount count = fixed->allow_short_last_step && !info_.is_multistep
                              ? count_steps(ivp.t0, ivp.t1, h)
                              : count_whole_steps(info_.name, ivp.t0, ivp.t1, h);
  const std::function<void(double, VectorRef)> no_dense_output;
  Solution solution;
  solution.time = ivp.t0;
  solution.state = ivp.y0;
  if (!observer.observe({0, ivp.t0, ivp.y0, false, no_dense_output})) {
    solution.status = {StatusCode::stopped_by_observer, "stopped at the start"};
    return solution;
  }
  const std::unique_ptr<Stepper> stepper = make_stepper_(ivp, h, solution.work);
  Vector y = ivp.y0;
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
    solution.time = t_next;
    solution.state = y;
    ++solution.work.accepted_steps;
    if (!observer.observe({n + 1, t_next, y, last, no_dense_output}) && !last) {
      solution.status = {StatusCode::stopped_by_observer, fmt::format("stopped at t = {:.6g}", t_next)};
      return solution;
    }
  }
  return solution;
}

}  // namespace fw::integrators
