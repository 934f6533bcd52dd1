#include "ode/integrator.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "core/error.hpp"

namespace fw {

Solution Integrator::solve(const Ivp& ivp, const StepControl& control, Observer& observer) const {
  if (!ivp.system) throw InputError("initial value problem without a system");
  if (ivp.y0.size() != ivp.system->size()) {
    throw InputError(
        fmt::format("initial state: found {} values, expected {}", ivp.y0.size(), ivp.system->size()));
  }
  if (!ivp.y0.allFinite()) throw InputError("initial state: found a value that is not finite");
  if (!std::isfinite(ivp.t0) || !std::isfinite(ivp.t1) || ivp.t1 <= ivp.t0) {
    throw InputError(fmt::format("end time: found {}, expected a finite number > {}", ivp.t1, ivp.t0));
  }
  if (info().needs_second_order && ivp.system->second_order() == nullptr) {
    throw InputError(fmt::format(
        "method \"{}\" needs a second-order system M q'' = f(t, q, q'), which this problem is not",
        info().name));
  }
  const auto start = std::chrono::steady_clock::now();
  Solution solution = do_solve(ivp, control, observer);
  solution.work.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return solution;
}

}  // namespace fw
