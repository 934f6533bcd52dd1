#pragma once

#include <memory>
#include <string>
#include <vector>

#include "catalog/methods.hpp"
#include "integrators/implicit_problems.hpp"
#include "integrators/network.hpp"

namespace fw::catalog {

/// A method on a problem that it can run on, with constant or chosen steps.
struct MethodRun {
  std::string call, problem;
  std::shared_ptr<const Integrator> integrator;
  Ivp ivp;
  StepControl control;

  std::string name() const {
    return call + " on " + problem +
           (std::holds_alternative<FixedStep>(control) ? ", constant steps" : ", tolerances");
  }
  bool is_foreign() const { return integrator->info().family == "oracle"; }
  bool is_fixed() const { return std::holds_alternative<FixedStep>(control); }
};

/// Steps of 1/64 s on intervals that are multiples of it: all times are exact.
inline constexpr double exact_step = 1.0 / 64.0;

struct NamedProblem {
  std::string name;
  Ivp ivp;
};

inline std::vector<NamedProblem> small_problems(int steps) {
  const double end = steps * exact_step;
  integrators::NetworkOptions damped, undamped;
  damped.particles = undamped.particles = 6;
  undamped.is_damped = false;
  std::vector<NamedProblem> problems = {{"damped network", integrators::random_network(7, damped, end)},
                                        {"undamped network", integrators::random_network(8, undamped, end)},
                                        {"first-order flow", integrators::coupled_first_order(0.3)}};
  problems.back().ivp.t0 = 0.25;
  problems.back().ivp.t1 = 0.25 + end;
  return problems;
}

/// The catalogue's methods and some calls with options. Each on every problem that it can run on, or on the
/// first of them only.
inline std::vector<MethodRun> method_runs(int steps, bool own_only, bool first_problem_only) {
  std::vector<std::string> calls;
  for (const MethodEntry& entry : methods()) calls.push_back(entry.name);
  for (const char* solver : {"cholesky", "ldlt", "lu", "eigen_cg", "eigen_lu", "cholmod"}) {
    calls.push_back(std::string("implicit_euler_linearised[linear_solver=") + solver + "]");
  }
  const std::vector<NamedProblem> problems = small_problems(steps);
  std::vector<MethodRun> runs;
  for (const std::string& call : calls) {
    const std::shared_ptr<const Integrator> integrator = make_method(call);
    const MethodInfo& info = integrator->info();
    if (own_only && info.family == "oracle") continue;
    for (const auto& [name, ivp] : problems) {
      if (!why_not_applicable(info, *ivp.system).empty()) continue;
      if (info.has_fixed_step) runs.push_back({call, name, integrator, ivp, FixedStep{.step = exact_step}});
      if (info.is_adaptive) {
        runs.push_back({call, name, integrator, ivp,
                        AdaptiveStep{.relative_tolerance = 1e-6,
                                     .absolute_tolerance = 1e-7,
                                     .maximum_step = (info.family == "oracle" ? 1.0 : 2.0) * exact_step}});
      }
      if (first_problem_only) break;
    }
  }
  return runs;
}

}  // namespace fw::catalog
