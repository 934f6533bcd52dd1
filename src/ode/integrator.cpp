#include "ode/integrator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/run_clock.hpp"
#include "ode/not_applicable.hpp"

namespace fw {

std::string why_not_applicable(const MethodInfo& info, const OdeSystem& system) {
  return why_lacking(info.needs, system);
}

int order_on(const MethodInfo& info, const OdeSystem& system) {
  const SecondOrderSystem* mechanics = system.second_order();
  const bool has_velocity_forces = mechanics != nullptr && mechanics->force_class() == ForceClass::velocity;
  return has_velocity_forces ? info.order_with_velocity_forces : info.order;
}

int dense_order_on(const MethodInfo& info, const OdeSystem& system) {
  const int order = order_on(info, system);
  return info.dense_output == DenseOutput::cubic_hermite ? std::min(order, 3) : order;
}

Solution Integrator::solve(const Ivp& ivp, const StepControl& control, Observer& observer,
                           const SolveOptions& options) const {
  if (!ivp.system) throw InputError("initial value problem without a system");
  if (ivp.y0.size() != ivp.system->size()) {
    throw InputError(
        fmt::format("initial state: found {} values, expected {}", ivp.y0.size(), ivp.system->size()));
  }
  if (!ivp.y0.allFinite()) throw InputError("initial state: found a value that is not finite");
  if (!std::isfinite(ivp.t0) || !std::isfinite(ivp.t1) || ivp.t1 <= ivp.t0) {
    throw InputError(fmt::format("end time: found {}, expected a finite number > {}", ivp.t1, ivp.t0));
  }
  if (const std::string why = why_not_applicable(info(), *ivp.system); !why.empty()) {
    throw NotApplicable(fmt::format("method \"{}\": {}", info().name, why));
  }
  const RunClock clock;
  Solution solution = do_solve(ivp, control, observer, options);
  const double before = options.resume.empty() ? 0.0 : solution.work.seconds;
  solution.work.seconds = before + clock.seconds();
  return solution;
}

}  // namespace fw
