#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "analysis/fit/order_fit.hpp"
#include "analysis/verification/verification.hpp"
#include "analysis/verification/verification_problems.hpp"
#include "integrators/loop/adaptive_integrator.hpp"

namespace fw::analysis {

void verify_error_estimate(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks) {
  PropertyCheck check{.property = "order of the error estimate"};
  const auto* adaptive = dynamic_cast<const integrators::AdaptiveIntegrator*>(&scheme.integrator);
  const MethodInfo& info = scheme.integrator.info();
  if (adaptive == nullptr) {
    check.reason = "no error estimate";
    checks.push_back(check);
    return;
  }
  const auto problems = applicable_problems(info, {damped_oscillators, driven_oscillators, first_order_flow,
                                                   damped_spring_network, spring_network});
  if (problems.empty()) {
    check.reason = "no problem for it";
    checks.push_back(check);
    return;
  }
  const Ivp& ivp = problems.front()();
  std::vector<double> steps, estimates;
  for (double h = 0.8; h > 1e-4; h *= 0.88) {
    Work work;
    const auto stepper = adaptive->make_stepper(ivp, work);
    Vector y_new(ivp.y0.size()), error(ivp.y0.size());
    if (!stepper->attempt(ivp.t0, h, ivp.y0, y_new, error).ok()) continue;
    steps.push_back(h);
    estimates.push_back(error.lpNorm<Eigen::Infinity>());
  }
  const int expected = std::min(info.order, info.embedded_order) + 1;
  const std::optional<double> slope = local_slope(steps, estimates, 2e-14);
  check.claimed = fmt::format("h^{}", expected);
  const schemes::DerivedProperties derived = schemes::derive(scheme.data);
  if (derived.embedded_order)
    check.derived = fmt::format("h^{}", std::min(*derived.order, *derived.embedded_order) + 1);
  check.measured = slope ? fmt::format("{:.2f}", *slope) : "no asymptotic range";
  check.verdict =
      slope && std::abs(*slope - expected) <= 0.1 + 0.03 * expected ? Verdict::holds : Verdict::fails;
  if (derived.embedded_order && check.derived != check.claimed) check.verdict = Verdict::fails;
  checks.push_back(check);
}

void verify_tolerance_proportionality(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks) {
  const MethodInfo& info = scheme.integrator.info();
  const char* property = "error against tolerance";
  if (!info.is_adaptive || info.embedded_order == 0) {
    checks.push_back({.property = property, .reason = "no error estimate of its own"});
    return;
  }
  // The step follows tol^{1/k}, the error the order p: slope p/k with k = min(p, p̂) + 1.
  const double expected =
      static_cast<double>(info.order) / static_cast<double>(std::min(info.order, info.embedded_order) + 1);
  PropertyCheck check{
      .property = property, .claimed = fmt::format("tol^{:.2f}", expected), .verdict = Verdict::holds};
  // Long enough for many steps of a high order at a loose tolerance, short enough for a low order at a tight
  // one.
  const double length = info.order >= 5 ? 12.0 : 3.0;
  int problems = 0;
  for (const ProblemFunction problem :
       applicable_problems(info, {damped_oscillators, driven_oscillators, conservative_oscillators,
                                  damped_spring_network, spring_network})) {
    if (++problems > 3) break;
    std::vector<double> tolerances, errors;
    double worst = 0.0;
    Status status;
    for (double tolerance = 1e-3; tolerance > 0.9e-10; tolerance /= std::sqrt(10.0)) {
      NullObserver observer;
      const Solution solution = scheme.integrator.solve(
          lengthened(problem, length),
          AdaptiveStep{.relative_tolerance = tolerance, .absolute_tolerance = tolerance}, observer);
      if (!solution.status.ok()) {
        status = solution.status;
        continue;
      }
      const double error = relative_error(solution.state, certified_end_of_lengthened(problem, length).value);
      tolerances.push_back(tolerance);
      errors.push_back(error);
      worst = std::max(worst, error / std::pow(tolerance, expected));
    }
    const double slope = logarithmic_slope(tolerances, errors);
    check.measured += fmt::format("{}{:.2f} (C {:.1f})", check.measured.empty() ? "" : ", ", slope, worst);
    if (!status.ok() || !(std::abs(slope - expected) <= 0.3 * expected) || !(worst <= 1000.0)) {
      check.verdict = Verdict::fails;
      if (!status.ok()) check.reason = status.describe();
    }
  }
  checks.push_back(check);
}

void verify_agreement(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks) {
  const MethodInfo& info = scheme.integrator.info();
  PropertyCheck check{.property = "agreement with the oracle"};
  const auto problems = applicable_problems(info, {damped_spring_network, spring_network, first_order_flow});
  if (scheme.oracle == nullptr || problems.empty() || !info.has_fixed_step || info.order == 0) {
    check.reason = "no oracle for it";
    checks.push_back(check);
    return;
  }
  const Ivp& ivp = problems.front()();
  NullObserver observer;
  constexpr double tolerance = 1e-10;
  const Solution oracle = scheme.oracle->solve(
      ivp, AdaptiveStep{.relative_tolerance = tolerance, .absolute_tolerance = tolerance}, observer);
  const bool damped = ivp.system->second_order() != nullptr &&
                      ivp.system->second_order()->force_class() == ForceClass::velocity;
  const int order = damped ? info.order_with_velocity_forces : info.order;
  const auto solve = [&](int count) {
    return scheme.integrator.solve(
        ivp, FixedStep{.step = (ivp.t1 - ivp.t0) / count, .allow_short_last_step = false}, observer);
  };
  const int count = order >= 3 ? 64 : 512;
  const Solution coarse = solve(count), fine = solve(2 * count);
  // Richardson's estimate of the finer run's error, with a factor of safety.
  const double estimate =
      3.0 * (coarse.state - fine.state).lpNorm<Eigen::Infinity>() / (std::pow(2.0, order) - 1.0);
  const double allowed = estimate + 100.0 * tolerance;
  const double difference = (fine.state - oracle.state).lpNorm<Eigen::Infinity>();
  check.claimed = fmt::format("within {:.1e}", allowed);
  check.measured = fmt::format("{:.1e}", difference);
  const bool ran = oracle.status.ok() && coarse.status.ok() && fine.status.ok();
  check.verdict = ran && difference <= allowed ? Verdict::holds : Verdict::fails;
  if (!ran)
    check.reason = (!oracle.status.ok() ? oracle : !coarse.status.ok() ? coarse : fine).status.describe();
  checks.push_back(check);
}

}  // namespace fw::analysis
