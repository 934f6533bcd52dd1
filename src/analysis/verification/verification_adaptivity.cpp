#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "analysis/fit/order_fit.hpp"
#include "analysis/reference/gragg_extrapolation.hpp"
#include "analysis/verification/verification.hpp"
#include "analysis/verification/verification_problems.hpp"
#include "integrators/loop/adaptive_integrator.hpp"
#include "schemes/order_conditions.hpp"

namespace fw::analysis {

namespace {

std::vector<ProblemFunction> applicable(const MethodInfo& info,
                                        std::initializer_list<ProblemFunction> problems) {
  std::vector<ProblemFunction> result;
  for (const ProblemFunction problem : problems) {
    if (why_not_applicable(info, *problem().system).empty()) result.push_back(problem);
  }
  return result;
}

/// The order of values at falling steps; coarse single steps may do anything.
std::optional<double> local_slope(const std::vector<double>& steps, const std::vector<double>& values,
                                  double floor) {
  const OrderFit fit = fit_finest_order(steps, values, floor, 0.15);
  if (!fit.valid) return std::nullopt;
  return fit.order;
}

/// Least squares slope of log error over log tolerance: all points, since step selection scatters them.
double logarithmic_slope(const std::vector<double>& x, const std::vector<double>& y) {
  const double n = static_cast<double>(x.size());
  double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double u = std::log(x[i]), v = std::log(std::max(y[i], 1e-300));
    sx += u;
    sy += v;
    sxx += u * u;
    sxy += u * v;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

double relative_error(ConstVectorRef y, const std::vector<Float128>& exact) {
  double error = 0.0, size = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const double value = static_cast<double>(exact[i]);
    error = std::max(error, std::abs(static_cast<double>(Float128(y[static_cast<Index>(i)]) - exact[i])));
    size = std::max(size, std::abs(value));
  }
  return error / size;
}

/// Remembers the dense output of the only step at fractions θ.
class SingleStep final : public Observer {
 public:
  SingleStep(double theta, Index size) : theta_(theta), value(size) {}
  bool observe(const StepView& view) override {
    if (view.index == 0) {
      start_ = view.time;
    } else if (view.index == 1 && view.interpolate) {
      view.interpolate(start_ + theta_ * (view.time - start_), value);
      seen = true;
    }
    return true;
  }

 private:
  double theta_, start_ = 0.0;

 public:
  Vector value;
  bool seen = false;
};

/// The order q of a dense output whose local error is O(h^{q+1}), from the tableau's weights b(θ).
int dense_order(const schemes::ButcherTableau& tableau, double theta) {
  schemes::TableauValues<Float128> t = schemes::values<Float128>(tableau);
  // y(t + θh) is a method of its own with step θh: a_ij/θ, b_i(θ)/θ.
  std::vector<Float128> weights;
  for (const std::vector<Float128>& polynomial : t.dense) {
    Float128 sum = 0;
    for (std::size_t k = polynomial.size(); k-- > 0;) sum = (sum + polynomial[k]) * theta;
    weights.push_back(sum / theta);
  }
  for (Float128& a : t.a) a /= theta;
  return schemes::order_of_weights(t, weights, 1e4 * schemes::uncertainty(tableau));
}

}  // namespace

void verify_error_estimate(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks) {
  PropertyCheck check{.property = "order of the error estimate"};
  const auto* adaptive = dynamic_cast<const integrators::AdaptiveIntegrator*>(&scheme.integrator);
  const MethodInfo& info = scheme.integrator.info();
  if (adaptive == nullptr) {
    check.reason = "no error estimate";
    checks.push_back(check);
    return;
  }
  const auto problems = applicable(info, {damped_oscillators, driven_oscillators, first_order_flow,
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

void verify_dense_output(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks) {
  PropertyCheck check{.property = "dense output"};
  const MethodInfo& info = scheme.integrator.info();
  const auto problems =
      applicable(info, {first_order_flow, damped_oscillators, driven_oscillators, spring_network});
  if (problems.empty() || !info.has_fixed_step || info.is_multistep || info.carries_more_than_state) {
    check.reason = "schemes whose single step says all only";
    checks.push_back(check);
    return;
  }
  const Ivp& ivp = problems.front()();
  constexpr double theta = 0.375;
  std::vector<double> steps, errors;
  for (double h = 0.8; h > 2e-4; h *= 0.75) {
    Ivp step = ivp;
    step.t1 = ivp.t0 + h;
    SingleStep observer(theta, ivp.y0.size());
    const Solution solution = scheme.integrator.solve(step, FixedStep{.step = h}, observer);
    if (!solution.status.ok() || !observer.seen) continue;
    const double time[] = {ivp.t0 + theta * (step.t1 - ivp.t0)};
    const ExtrapolationRun exact = integrate_by_extrapolation(
        ivp, time, {.tableau = harmonic_extrapolation(7), .tolerance = 1e-20, .least_steps = 4});
    steps.push_back(h);
    errors.push_back(relative_error(observer.value, exact.states.front()));
  }
  const int order = std::min(
      info.order, info.order_with_velocity_forces > 0 ? info.order_with_velocity_forces : info.order);
  const auto* tableau = std::get_if<schemes::ButcherTableau>(&scheme.data);
  // The cubic Hermite polynomial is good to O(h⁴), and never better than the end of the step.
  const bool own = tableau != nullptr && !tableau->dense.empty();
  const int expected = own ? dense_order(*tableau, theta) : std::min(order, 3);
  const std::optional<double> slope = local_slope(steps, errors, 1e-14);
  check.claimed = own ? "own polynomial" : "cubic Hermite";
  check.derived = std::to_string(expected);
  check.measured = slope ? fmt::format("{:.2f}", *slope - 1.0) : "no asymptotic range";
  check.verdict = slope && std::abs(*slope - 1.0 - expected) <= 0.25 ? Verdict::holds : Verdict::fails;
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
       applicable(info, {damped_oscillators, driven_oscillators, conservative_oscillators,
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
  const auto problems = applicable(info, {damped_spring_network, spring_network, first_order_flow});
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
