#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "analysis/fit/order_fit.hpp"
#include "analysis/verification/verification.hpp"
#include "analysis/verification/verification_problems.hpp"

namespace fw::analysis {

namespace {

/// |p̂ − p| has to be at most this on smooth problems.
constexpr double order_window = 0.1;
constexpr double smallest_correlation = 0.999;
/// Local slopes in the asymptotic range differ by at most this.
constexpr double slope_tolerance = 0.05;
/// From this order on double rounding leaves too few points between floor and pre-asymptotic range.
constexpr int extended_from_order = 4;

/// Relative errors of both halves of the state; equal where the system is not of second order.
struct Errors {
  double position, velocity;
};

Errors errors_of(const OdeSystem& system, const std::vector<Float128>& y,
                 const std::vector<Float128>& exact) {
  const auto relative = [&](std::size_t begin, std::size_t end) {
    Float128 error = 0, size = 0;
    for (std::size_t i = begin; i < end; ++i) {
      error = std::max(error, Float128(abs(y[i] - exact[i])));
      size = std::max(size, Float128(abs(exact[i])));
    }
    return static_cast<double>(error / size);
  };
  const std::size_t n = y.size();
  if (system.second_order() == nullptr) return {relative(0, n), relative(0, n)};
  return {relative(0, n / 2), relative(n / 2, n)};
}

/// Runs the scheme over finer and finer steps and fits the order.
class OrderMeasurement {
 public:
  OrderMeasurement(const Integrator& integrator, ProblemFunction problem, int expected)
      : integrator_(integrator),
        problem_(problem),
        expected_(expected),
        extended_(expected >= extended_from_order && integrator.extended_solver()) {}

  void run() {
    // High orders cross the range above the floor in few steps: finer levels there.
    const double ratio = expected_ >= 4 ? 1.15 : 1.3;
    const double floor = extended_ ? std::max(1e-27, 100.0 * relative_reference_error()) : 2e-12;
    const double most_steps = extended_ ? 3000.0 : 30000.0;
    constexpr double fewest_steps = 300.0;
    int at_floor = 0;
    double last_count = 0.0;
    for (double count = 8.0; count <= most_steps && at_floor < 2; count *= ratio) {
      const double whole = std::round(count);
      if (whole <= last_count) continue;
      last_count = whole;
      const std::optional<Errors> errors = solve(static_cast<std::uint64_t>(whole));
      if (!errors) continue;
      steps_.push_back(1.0 / whole);
      position_.push_back(errors->position);
      velocity_.push_back(errors->velocity);
      if (std::max(errors->position, errors->velocity) < floor) ++at_floor;
      // Low orders never come near the floor: slopes that no longer change end the run.
      if (whole > fewest_steps && slopes_have_settled(position_) && slopes_have_settled(velocity_)) break;
    }
    // Runs in binary128 carry no noise above the floor, but errors of high order change signs on coarse
    // steps.
    const auto fit = extended_ ? fit_finest_order : fit_order;
    position_fit = fit(steps_, position_, floor, slope_tolerance);
    velocity_fit = fit(steps_, velocity_, floor, slope_tolerance);
  }

  bool extended() const { return extended_; }

  OrderFit position_fit, velocity_fit;
  std::string failure;

 private:
  /// Whether the last five local slopes agree with each other; looks at the data only.
  bool slopes_have_settled(const std::vector<double>& errors) const {
    constexpr std::size_t points = 6;
    if (errors.size() < points) return false;
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (std::size_t k = errors.size() - points + 1; k < errors.size(); ++k) {
      const double slope = std::log(errors[k - 1] / errors[k]) / std::log(steps_[k - 1] / steps_[k]);
      least = std::min(least, slope);
      most = std::max(most, slope);
    }
    return std::abs(most - least) < 0.2 * slope_tolerance;  // false for NaN
  }

  double relative_reference_error() const {
    double largest = 0.0;
    for (int member = 0; member < ensemble_size; ++member) {
      const ReferenceState& exact = certified_end(problem_, member);
      Float128 size = 0;
      for (const Float128& y : exact.value) size = std::max(size, Float128(abs(y)));
      largest = std::max(largest, exact.largest_error() / static_cast<double>(size));
    }
    return largest;
  }

  /// Root mean squares of the errors over the ensemble.
  std::optional<Errors> solve(std::uint64_t count) {
    Errors sum{0.0, 0.0};
    for (int member = 0; member < ensemble_size; ++member) {
      const std::optional<Errors> errors = solve_member(count, member);
      if (!errors) return std::nullopt;
      sum.position += errors->position * errors->position / ensemble_size;
      sum.velocity += errors->velocity * errors->velocity / ensemble_size;
    }
    return Errors{std::sqrt(sum.position), std::sqrt(sum.velocity)};
  }

  std::optional<Errors> solve_member(std::uint64_t count, int member) {
    const Ivp& ivp = ensemble_member(problem_, member);
    const ReferenceState& exact = certified_end(problem_, member);
    if (extended_) return errors_of(*ivp.system, integrator_.extended_solver()(ivp, count), exact.value);
    NullObserver observer;
    const Solution solution = integrator_.solve(
        ivp,
        FixedStep{.step = (ivp.t1 - ivp.t0) / static_cast<double>(count), .allow_short_last_step = false},
        observer);
    if (!solution.status.ok()) {
      failure = solution.status.describe();
      return std::nullopt;
    }
    std::vector<Float128> state(solution.state.begin(), solution.state.end());
    return errors_of(*ivp.system, state, exact.value);
  }

  const Integrator& integrator_;
  ProblemFunction problem_;
  int expected_;
  bool extended_;
  std::vector<double> steps_, position_, velocity_;
};

PropertyCheck judge(const char* property, int claimed, const std::optional<int>& derived,
                    const OrderMeasurement& measurement) {
  PropertyCheck check{.property = property, .claimed = std::to_string(claimed)};
  if (derived) check.derived = std::to_string(*derived);
  check.verdict = Verdict::holds;
  const auto fail = [&](const std::string& why) {
    check.verdict = Verdict::fails;
    check.reason += (check.reason.empty() ? "" : "; ") + why;
  };
  const auto judge_fit = [&](const char* name, const OrderFit& fit) {
    if (!fit.valid) {
      fail(fmt::format("{}: {}{}", name, fit.reason,
                       measurement.failure.empty() ? "" : "; last failure: " + measurement.failure));
    } else if (std::abs(fit.order - claimed) > order_window || fit.correlation < smallest_correlation) {
      fail(fmt::format("{}: order {:.3f} [{:.3f}, {:.3f}], r = {:.5f}", name, fit.order, fit.order_low,
                       fit.order_high, fit.correlation));
    }
  };
  judge_fit("q", measurement.position_fit);
  judge_fit("v", measurement.velocity_fit);
  check.measured =
      fmt::format("{:.3f}, {:.3f}", measurement.position_fit.order, measurement.velocity_fit.order);
  if (derived && *derived != claimed) fail(fmt::format("derived {}, claimed {}", *derived, claimed));
  if (measurement.extended()) check.reason += check.reason.empty() ? "binary128" : "; binary128";
  return check;
}

void check_order(const SchemeUnderTest& scheme, const char* property, int claimed,
                 const std::optional<int>& derived, std::initializer_list<ProblemFunction> problems,
                 std::vector<PropertyCheck>& checks) {
  const ProblemFunction problem = first_applicable(scheme.integrator.info(), problems);
  if (problem == nullptr || claimed == 0 || !scheme.integrator.info().has_fixed_step) {
    checks.push_back({.property = property,
                      .reason = problem == nullptr ? "the scheme is not for this class of problems"
                                                   : "the scheme has no fixed order"});
    return;
  }
  OrderMeasurement measurement(scheme.integrator, problem, claimed);
  measurement.run();
  checks.push_back(judge(property, claimed, derived, measurement));
}

/// The run in binary128 shows the order of the code in double only if both are the same scheme: they have to
/// agree to rounding and to what iterative solvers leave.
void check_extended_twin(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks) {
  PropertyCheck check{.property = "double and binary128 agree"};
  const MethodInfo& info = scheme.integrator.info();
  if (!scheme.integrator.extended_solver() || !info.has_fixed_step) {
    check.reason = "double only";
    checks.push_back(check);
    return;
  }
  double largest = 0.0;
  for (const ProblemFunction problem : {driven_oscillators, damped_oscillators, first_order_flow}) {
    const Ivp& ivp = problem();
    if (!why_not_applicable(info, *ivp.system).empty()) continue;
    constexpr std::uint64_t count = 24;
    NullObserver observer;
    const Solution solution = scheme.integrator.solve(
        ivp, FixedStep{.step = (ivp.t1 - ivp.t0) / count, .allow_short_last_step = false}, observer);
    if (!solution.status.ok()) check.reason = solution.status.describe();
    const std::vector<Float128> state(solution.state.begin(), solution.state.end());
    const Errors errors = errors_of(*ivp.system, state, scheme.integrator.extended_solver()(ivp, count));
    largest = std::max({largest, errors.position, errors.velocity});
  }
  constexpr double rounding = 1e-12;
  check.claimed = "the same scheme";
  check.measured = fmt::format("differ by {:.1e}", largest);
  check.verdict = check.reason.empty() && largest <= std::max(rounding, 10.0 * info.iteration_tolerance)
                      ? Verdict::holds
                      : Verdict::fails;
  checks.push_back(check);
}

}  // namespace

void verify_order(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks) {
  const MethodInfo& info = scheme.integrator.info();
  const schemes::DerivedProperties derived = schemes::derive(scheme.data);
  check_order(scheme, "order, forces f(t, q)", info.order, derived.order,
              {driven_oscillators, spring_network}, checks);
  check_order(scheme, "order, forces f(t, q, v)", info.order_with_velocity_forces,
              derived.order_with_velocity_forces, {damped_oscillators, damped_spring_network}, checks);
  check_order(scheme, "order, y' = f(t, y)", info.order, derived.order, {first_order_flow}, checks);
  check_extended_twin(scheme, checks);
}

}  // namespace fw::analysis
