#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "analysis/fit/order_fit.hpp"
#include "analysis/reference/gragg_extrapolation.hpp"
#include "analysis/verification/verification.hpp"
#include "analysis/verification/verification_problems.hpp"

namespace fw::analysis {

namespace {

/// Frames may err so many times as much as the ends of runs.
constexpr double allowed_frame_error = 10.0;
/// Below, rounding is what is compared.
constexpr double error_of_rounding = 2e-14;

/// Places inside a step, and its end.
constexpr std::array places{0.2, 0.5, 0.85, 1.0};
constexpr std::size_t inner_places = places.size() - 1;

/// Remembers the dense output of the only step at `places`, and its end.
class SingleStep final : public Observer {
 public:
  bool observe(const StepView& view) override {
    if (view.index == 0) {
      start_ = view.time;
      return true;
    }
    if (view.index > 1 || !view.interpolate) return false;
    for (std::size_t k = 0; k < inner_places; ++k) {
      times[k] = start_ + places[k] * (view.time - start_);
      states[k].resize(view.state.size());
      view.interpolate(times[k], states[k]);
    }
    times.back() = view.time;
    states.back() = view.state;
    was_seen = true;
    return true;
  }

  std::array<double, places.size()> times{};
  std::array<Vector, places.size()> states{};
  bool was_seen = false;

 private:
  double start_ = 0.0;
};

/// What steps of a length err inside and at their ends, root mean squares.
struct StepErrors {
  double inside = 0.0, end = 0.0;
};

/// From one initial state. Nothing where the step fails.
std::optional<StepErrors> errors_of_step(const Integrator& integrator, const Ivp& ivp, double h) {
  Ivp step = ivp;
  step.t1 = ivp.t0 + h;
  SingleStep seen;
  const Solution solution = integrator.solve(step, FixedStep{.step = h}, seen);
  if (!solution.status.ok() || !seen.was_seen) return std::nullopt;
  const ExtrapolationRun exact = integrate_by_extrapolation(
      ivp, seen.times, {.tableau = harmonic_extrapolation(7), .tolerance = 1e-20, .least_steps = 4});
  StepErrors errors{.end = relative_error(seen.states.back(), exact.states.back())};
  for (std::size_t k = 0; k < inner_places; ++k) {
    errors.inside = std::hypot(errors.inside, relative_error(seen.states[k], exact.states[k]));
  }
  errors.inside /= std::sqrt(static_cast<double>(inner_places));
  return errors;
}

/// From several initial states, so that the leading error vanishes in none of the sums.
std::optional<StepErrors> errors_of_steps(const Integrator& integrator, ProblemFunction problem, double h) {
  StepErrors sum;
  for (int member = 0; member < ensemble_size; ++member) {
    const std::optional<StepErrors> found = errors_of_step(integrator, ensemble_start(problem, member), h);
    if (!found) return std::nullopt;
    sum.inside = std::hypot(sum.inside, found->inside);
    sum.end = std::hypot(sum.end, found->end);
  }
  return sum;
}

/// The slope of errors inside a step from that of errors at its end, `end_slope`, by their quotient on the finest
/// steps: both change sign and size alike where steps are too long for an asymptotic range, as those of
/// order 8 are in double.
std::optional<double> slope_by_comparison(const std::vector<double>& steps, const std::vector<double>& errors,
                                          const std::vector<double>& ends, int end_slope) {
  constexpr std::size_t fewest_points = 6, most_points = 8;
  std::vector<double> x, quotient;
  for (std::size_t k = steps.size(); k-- > 0 && x.size() < most_points;) {
    if (std::min(errors[k], ends[k]) < error_of_rounding) continue;
    x.push_back(steps[k]);
    quotient.push_back(errors[k] / ends[k]);
  }
  if (x.size() < fewest_points) return std::nullopt;
  return end_slope + logarithmic_slope(x, quotient);
}

/// Largest error of frames at equal spacing, up to that of the end of the run, and the error there.
class FrameErrors final : public Observer {
 public:
  FrameErrors(const FrameReference& reference, std::size_t last) : reference_(reference), last_(last) {}

  bool observe(const StepView& view) override {
    if (view.index == 0) return true;
    inside_.resize(view.state.size());
    for (; next_ < last_ && reference_.times[next_] < view.time; ++next_) {
      view.interpolate(reference_.times[next_], inside_);
      const double error = relative_error(inside_, reference_.states[next_]);
      if (error > largest || std::isnan(error)) largest = error;  // NaN stays
    }
    if (view.last) end = relative_error(view.state, reference_.states[last_]);
    return true;
  }

  double largest = 0.0, end = 0.0;

 private:
  const FrameReference& reference_;
  std::size_t last_, next_ = 0;
  Vector inside_;
};

}  // namespace

void verify_dense_output(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks) {
  PropertyCheck check{.property = "dense output"};
  const MethodInfo& info = scheme.integrator.info();
  const auto problems =
      applicable_problems(info, {first_order_flow, damped_oscillators, driven_oscillators, spring_network});
  if (problems.empty() || !info.has_fixed_step || info.is_multistep || info.carries_more_than_state) {
    check.reason = "schemes whose single step says all only";
    checks.push_back(check);
    return;
  }
  const Ivp& ivp = problems.front()();
  std::vector<double> steps, errors, ends;
  double share = 0.0;  // of the errors inside in that at the end, on the finest steps
  for (double h = 2.4; h > 2e-4; h *= 0.8) {
    const std::optional<StepErrors> found = errors_of_steps(scheme.integrator, problems.front(), h);
    if (!found) continue;
    steps.push_back(h);
    errors.push_back(found->inside);
    ends.push_back(found->end);
    if (found->inside < error_of_rounding) break;
    share = found->inside / std::max(found->end, error_of_rounding);
  }
  const int expected = dense_order_on(info, *ivp.system);
  check.claimed = fmt::format("order {}, {}", expected, to_string(info.dense_output));
  const schemes::DerivedProperties derived = schemes::derive(scheme.data);
  if (derived.order && info.dense_output != DenseOutput::cubic_hermite) {
    check.derived = std::to_string(
        order_on(info, *ivp.system) == info.order ? *derived.order : info.order_with_velocity_forces);
  }
  std::optional<double> slope = local_slope(steps, errors, error_of_rounding);
  const bool is_compared = !slope;
  if (is_compared) slope = slope_by_comparison(steps, errors, ends, order_on(info, *ivp.system) + 1);
  check.measured = slope ? fmt::format("{:.2f}{}, errors {:.2g} of the step's", *slope - 1.0,
                                       is_compared ? " by comparison with the step" : "", share)
                         : "no asymptotic range";
  check.verdict = slope && std::abs(*slope - 1.0 - expected) <= 0.1 + 0.03 * (expected + 1) ? Verdict::holds
                                                                                            : Verdict::fails;
  if (!check.derived.empty() && check.derived != std::to_string(expected)) check.verdict = Verdict::fails;
  checks.push_back(check);
}

void verify_frames(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks) {
  const MethodInfo& info = scheme.integrator.info();
  PropertyCheck check{.property = "frames against the end", .verdict = Verdict::holds};
  if (!info.is_adaptive) {
    checks.push_back({.property = check.property, .reason = "no steps chosen by tolerances"});
    return;
  }
  check.claimed = fmt::format("errors <= {} times those at ends of runs", allowed_frame_error);
  int problems = 0;
  for (const ProblemFunction problem :
       applicable_problems(info, {spring_network, damped_spring_network, conservative_oscillators,
                                  damped_oscillators, first_order_flow})) {
    if (++problems > 3) break;
    const FrameReference& reference = certified_frames(problem);
    double worst = 0.0;
    // Methods of low order take too many steps where the tolerance is tight.
    const bool is_low = info.order == 1 || info.order == 2;
    for (const double tolerance : is_low ? std::array{1e-3, 1e-4, 1e-5} : std::array{1e-4, 1e-6, 1e-8}) {
      // The error may happen to pass through zero at an end, hardly at three.
      double frames = 0.0, ends = error_of_rounding;
      for (const std::size_t part : {4, 3, 2}) {
        const std::size_t last = reference.times.size() * part / 4 - 1;
        Ivp ivp = reference.ivp;
        ivp.t1 = reference.times[last];
        FrameErrors errors(reference, last);
        const Solution solution = scheme.integrator.solve(
            ivp, AdaptiveStep{.relative_tolerance = tolerance, .absolute_tolerance = tolerance}, errors);
        if (!solution.status.ok()) {
          check.verdict = Verdict::fails;
          check.reason = solution.status.describe();
          continue;
        }
        if (errors.largest > frames || std::isnan(errors.largest)) frames = errors.largest;
        ends = std::max(ends, errors.end);
      }
      const double ratio = frames / ends;
      if (ratio > worst || std::isnan(ratio)) worst = ratio;
    }
    check.measured += fmt::format("{}{:.2g}", check.measured.empty() ? "" : ", ", worst);
    if (!(worst <= allowed_frame_error)) check.verdict = Verdict::fails;
  }
  if (problems == 0) check = {.property = check.property, .reason = "no problem for it"};
  checks.push_back(check);
}

}  // namespace fw::analysis
