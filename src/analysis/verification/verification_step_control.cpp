#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/verification/verification.hpp"
#include "analysis/verification/verification_problems.hpp"
#include "core/error.hpp"
#include "integrators/loop/adaptive_integrator.hpp"

namespace fw::analysis {

namespace {

double relative_difference(ConstVectorRef a, ConstVectorRef b) {
  return (a - b).lpNorm<Eigen::Infinity>() / b.lpNorm<Eigen::Infinity>();
}

Vector in_double(const std::vector<Float128>& exact) {
  Vector y(static_cast<Index>(exact.size()));
  std::transform(exact.begin(), exact.end(), y.begin(),
                 [](const Float128& x) { return static_cast<double>(x); });
  return y;
}

/// The error at the end of an interval of 20.4 steps is that of 20 or 21 steps.
void check_shorter_last_step(const SchemeUnderTest& scheme, ProblemFunction problem,
                             std::vector<PropertyCheck>& checks) {
  const MethodInfo& info = scheme.integrator.info();
  PropertyCheck check{.property = "shorter last step"};
  const Ivp& ivp = problem();
  const Vector exact = in_double(certified_end(problem, 0).value);
  const auto solve = [&](double steps) {
    NullObserver observer;
    return scheme.integrator.solve(ivp, FixedStep{.step = (ivp.t1 - ivp.t0) / steps}, observer);
  };
  if (info.is_multistep) {
    check.claimed = "refused";
    bool refused = false;
    try {
      solve(20.4);
    } catch (const InputError&) {
      refused = true;
    }
    check.measured = refused ? "refused" : "taken";
    check.verdict = refused ? Verdict::holds : Verdict::fails;
    if (!refused) check.reason = "a multistep scheme with constant steps cannot make a shorter one";
    checks.push_back(check);
    return;
  }
  const Solution broken = solve(20.4), longer = solve(20.0), shorter = solve(21.0);
  const double error = relative_difference(broken.state, exact);
  const double whole =
      std::max(relative_difference(longer.state, exact), relative_difference(shorter.state, exact));
  constexpr double factor = 3.0, rounding = 1e-12;
  check.claimed = "taken";
  check.measured = fmt::format("error {:.1e}, whole steps {:.1e}", error, whole);
  const bool ran = broken.status.ok() && longer.status.ok() && shorter.status.ok();
  check.verdict =
      ran && broken.time == ivp.t1 && error <= factor * whole + rounding ? Verdict::holds : Verdict::fails;
  if (check.verdict == Verdict::fails) {
    check.reason = ran ? fmt::format("ends at t = {:.17g} of {:.17g}", broken.time, ivp.t1)
                       : (!broken.status.ok()   ? broken
                          : !longer.status.ok() ? longer
                                                : shorter)
                             .status.describe();
  }
  checks.push_back(check);
}

/// What two ways to the same step may differ by: rounding, and what Newton's iteration leaves.
double allowed_difference(const MethodInfo& info) {
  return std::max(1e-12, 10.0 * info.iteration_tolerance);
}

/// An attempt and a constant step from the same state are the same step.
void check_attempted_steps(const SchemeUnderTest& scheme, const integrators::AdaptiveIntegrator& adaptive,
                           const Ivp& ivp, std::vector<PropertyCheck>& checks) {
  const double h = (ivp.t1 - ivp.t0) / 16.0;
  Work work;
  Vector y = ivp.y0, y_new(ivp.y0.size()), error(ivp.y0.size());
  const bool ran = adaptive.make_stepper(ivp, work)->step(ivp.t0, h, y).ok() &&
                   adaptive.make_stepper(ivp, work)->attempt(ivp.t0, h, ivp.y0, y_new, error).ok();
  const double difference = relative_difference(y_new, y);
  checks.push_back({.property = "attempted steps",
                    .claimed = "as constant ones",
                    .measured = fmt::format("differ by {:.1e}", difference),
                    .verdict = ran && difference <= allowed_difference(scheme.integrator.info())
                                   ? Verdict::holds
                                   : Verdict::fails});
}

/// A first step as long as the interval has to be rejected and must leave no trace: neither in the next
/// attempt nor in the result.
void check_rejected_steps(const SchemeUnderTest& scheme, const integrators::AdaptiveIntegrator* adaptive,
                          ProblemFunction problem, std::vector<PropertyCheck>& checks) {
  const Ivp& ivp = problem();
  PropertyCheck check{.property = "rejected steps", .claimed = "leave no trace", .verdict = Verdict::holds};
  if (adaptive != nullptr) {
    const double h = (ivp.t1 - ivp.t0) / 8.0;
    Work work;
    Vector again(ivp.y0.size()), fresh(ivp.y0.size()), error(ivp.y0.size());
    const auto stepper = adaptive->make_stepper(ivp, work);
    const bool ran = stepper->attempt(ivp.t0, h, ivp.y0, again, error).ok() &&
                     stepper->attempt(ivp.t0, 0.5 * h, ivp.y0, again, error).ok() &&
                     adaptive->make_stepper(ivp, work)->attempt(ivp.t0, 0.5 * h, ivp.y0, fresh, error).ok();
    const double difference = relative_difference(again, fresh);
    check.measured = fmt::format("differ by {:.1e}, ", difference);
    if (!ran || !(difference <= allowed_difference(scheme.integrator.info()))) {
      check.verdict = Verdict::fails;
      check.reason = "an attempt after a rejected one is another step";
    }
  }
  const Vector exact = in_double(certified_end(problem, 0).value);
  constexpr double tolerance = 1e-8, factor = 10.0;
  const auto solve = [&](double initial_step) {
    NullObserver observer;
    return scheme.integrator.solve(
        ivp,
        AdaptiveStep{
            .relative_tolerance = tolerance, .absolute_tolerance = tolerance, .initial_step = initial_step},
        observer);
  };
  const Solution solution = solve(ivp.t1 - ivp.t0), chosen = solve(0.0);
  const double error = relative_difference(solution.state, exact);
  const double usual = relative_difference(chosen.state, exact);
  check.measured += fmt::format("{} rejected, error {:.1f} tol and {:.1f} tol without",
                                solution.work.rejected_steps, error / tolerance, usual / tolerance);
  if (!solution.status.ok() || !chosen.status.ok() || solution.work.rejected_steps == 0 ||
      !(error <= factor * std::max(usual, tolerance))) {
    check.verdict = Verdict::fails;
    check.reason += fmt::format("{}from a first step as long as the interval: {}",
                                check.reason.empty() ? "" : "; ", solution.status.describe());
  }
  checks.push_back(check);
}

}  // namespace

void verify_step_control(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks) {
  const MethodInfo& info = scheme.integrator.info();
  const ProblemFunction problem = first_applicable(
      info,
      {damped_oscillators, driven_oscillators, first_order_flow, damped_spring_network, spring_network});
  if (problem == nullptr || !info.has_fixed_step) {
    checks.push_back({.property = "shorter last step", .reason = "the scheme has no constant steps"});
    return;
  }
  check_shorter_last_step(scheme, problem, checks);
  if (!info.is_adaptive || info.embedded_order == 0) {
    checks.push_back({.property = "rejected steps", .reason = "no error estimate of its own"});
    return;
  }
  const auto* adaptive = dynamic_cast<const integrators::AdaptiveIntegrator*>(&scheme.integrator);
  if (adaptive != nullptr) check_attempted_steps(scheme, *adaptive, problem(), checks);
  check_rejected_steps(scheme, adaptive, problem, checks);
}

}  // namespace fw::analysis
