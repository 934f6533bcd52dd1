#include "ode/step_control.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/error.hpp"

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

}  // namespace fw
