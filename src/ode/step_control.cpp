#include "ode/step_control.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/error.hpp"
#include "ode/second_order_system.hpp"

namespace fw {

StepCount count_steps(double t0, double t1, double step) {
  if (!std::isfinite(step) || step <= 0.0) {
    throw InputError(fmt::format("step: found {}, expected a finite number > 0", step));
  }
  if (!std::isfinite(t0) || !std::isfinite(t1) || t1 <= t0) {
    throw InputError(fmt::format("end time: found {}, expected a finite number > {}", t1, t0));
  }
  const double quotient = (t1 - t0) / step;
  if (quotient >= 9007199254740992.0) {
    throw InputError(fmt::format("step: {} needs {:.3g} steps, expected fewer than 2^53", step, quotient));
  }
  const double nearest = std::round(quotient);
  if (nearest >= 1.0 && std::abs(quotient - nearest) <= 1e-9 * nearest) {
    return {.whole = static_cast<std::uint64_t>(nearest), .remainder = 0.0};
  }
  const double whole = std::floor(quotient);
  return {.whole = static_cast<std::uint64_t>(whole), .remainder = (t1 - t0) - whole * step};
}

StepCount count_whole_steps(std::string_view method, double t0, double t1, double step) {
  const StepCount count = count_steps(t0, t1, step);
  if (count.remainder <= 0.0) return count;
  const double length = t1 - t0;
  const double smaller = length / static_cast<double>(count.whole + 1);
  const std::string fitting = count.whole == 0
                                  ? fmt::format("the largest step that fits is {}", smaller)
                                  : fmt::format("the nearest steps that fit are {} and {}", smaller,
                                                length / static_cast<double>(count.whole));
  throw InputError(
      fmt::format("step {} does not divide the interval of length {}: method \"{}\" needs a whole number of "
                  "steps; {}",
                  step, length, method, fitting));
}

bool AdaptiveStep::has_velocity_tolerance(const OdeSystem& system) const {
  return absolute_velocity_tolerance > 0.0 && absolute_velocity_tolerance != absolute_tolerance &&
         system.second_order() != nullptr;
}

Vector absolute_tolerances(const AdaptiveStep& control, Index size, Index first_velocity, Index n) {
  Vector tolerances = Vector::Constant(size, control.absolute_tolerance);
  if (control.absolute_velocity_tolerance > 0.0) {
    tolerances.segment(first_velocity, n).setConstant(control.absolute_velocity_tolerance);
  }
  return tolerances;
}

Vector absolute_tolerances(const AdaptiveStep& control, const OdeSystem& system) {
  const SecondOrderSystem* second_order = system.second_order();
  const Index n = second_order == nullptr ? 0 : second_order->degrees_of_freedom();
  return absolute_tolerances(control, system.size(), n, n);
}

void check_tolerances(std::string_view method, const AdaptiveStep& control) {
  const auto require = [&](bool holds, const std::string& what) {
    if (!holds) throw InputError(fmt::format("method \"{}\": {}", method, what));
  };
  require(std::isfinite(control.relative_tolerance) && control.relative_tolerance > 0.0,
          fmt::format("relative tolerance: found {}, expected > 0", control.relative_tolerance));
  require(std::isfinite(control.absolute_tolerance) && control.absolute_tolerance > 0.0,
          fmt::format("absolute tolerance: found {}, expected > 0", control.absolute_tolerance));
  require(std::isfinite(control.absolute_velocity_tolerance) && control.absolute_velocity_tolerance >= 0.0,
          fmt::format("absolute tolerance of velocities: found {}, expected > 0, or 0 for that of positions",
                      control.absolute_velocity_tolerance));
  require(control.initial_step >= 0.0 && std::isfinite(control.initial_step),
          fmt::format("initial step: found {}, expected >= 0", control.initial_step));
  require(control.minimum_step >= 0.0 && control.maximum_step > control.minimum_step,
          fmt::format("step limits: found {} to {}, expected 0 <= minimum < maximum", control.minimum_step,
                      control.maximum_step));
  require(control.initial_step == 0.0 || control.initial_step >= control.minimum_step,
          fmt::format("initial step: found {}, expected at least the minimum of {}", control.initial_step,
                      control.minimum_step));
}

}  // namespace fw
