#include "ode/integrator.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "core/error.hpp"

namespace fw {

std::string why_not_applicable(const MethodInfo& info, const OdeSystem& system) {
  const SecondOrderSystem* second_order = system.second_order();
  if (info.needs_second_order && second_order == nullptr) {
    return "the method needs M q'' = f(t, q, q'), the problem is y' = f(t, y)";
  }
  if (info.needs_position_forces && second_order->force_class() != ForceClass::position) {
    return "the method needs forces f(t, q), those of the problem depend on velocity";
  }
  if (info.needs_springs && !second_order->has_springs()) {
    return "the method needs a mass-spring system";
  }
  if (info.needs_force_splitting && (second_order == nullptr || second_order->force_splitting() == nullptr)) {
    return "the method needs forces in a stiff and a soft part, as a mass-spring system has them";
  }
  return {};
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
    throw InputError(fmt::format("method \"{}\": {}", info().name, why));
  }
  const auto start = std::chrono::steady_clock::now();
  Solution solution = do_solve(ivp, control, observer, options);
  const double before = options.resume.empty() ? 0.0 : solution.work.seconds;
  solution.work.seconds =
      before + std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return solution;
}

}  // namespace fw
