#include "analysis/reference/converged_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fw::analysis {

namespace {

/// Differences that fall by less than this are taken to fall by this: they are noise or do not converge, and
/// the estimate then is ten times the difference.
constexpr double smallest_ratio = 1.1;

/// Follows the differences of successive runs.
class Refinement {
 public:
  Refinement(const Integrator& integrator, const Ivp& ivp, const std::function<double(ConstVectorRef)>& norm,
             const RefinementGoal& goal)
      : integrator_(integrator), ivp_(ivp), norm_(norm), goal_(goal) {
    result_.error_estimate = std::numeric_limits<double>::infinity();
  }

  /// Runs once more. `expected_ratio` is by how much a difference can at most be smaller than the one before.
  /// Returns whether to go on.
  bool refine(const StepControl& control, double expected_ratio) {
    NullObserver observer;
    Solution solution = integrator_.solve(ivp_, control, observer, {.stop = goal_.stop});
    result_.status = solution.status;
    if (solution.status.code == StatusCode::interrupted) return false;
    if (solution.status.code == StatusCode::step_limit) return false;  // a finer run needs even more
    result_.warning = solution.warnings.empty() ? "" : solution.warnings.front();
    if (!solution.status.ok() || !result_.warning.empty()) {
      previous_difference_ = std::numeric_limits<double>::infinity();
      return true;  // a finer run may succeed
    }
    if (result_.state.size() > 0) {
      const double difference = norm_(solution.state - result_.state);
      // A run that is no finer says nothing, and what is known from the runs before stays.
      if (solution.work.accepted_steps <= result_.work.accepted_steps) return true;
      result_.error_estimate = estimate(difference, expected_ratio);
      previous_difference_ = difference;
    }
    result_.state = std::move(solution.state);
    result_.work = solution.work;
    const auto* fixed = std::get_if<FixedStep>(&control);
    result_.step = fixed != nullptr ? fixed->step : 0.0;
    result_.tolerance = fixed != nullptr ? 0.0 : std::get<AdaptiveStep>(control).relative_tolerance;
    return !(result_.error_estimate <= goal_.error);
  }

  /// The error of the finest run from the last two differences: d/(ρ − 1) if they fall by a factor ρ < 2.
  double estimate(double difference, double expected_ratio) const {
    if (!std::isfinite(previous_difference_)) return std::numeric_limits<double>::infinity();  // one more run
    if (difference == 0.0) return previous_difference_ / expected_ratio;
    const double ratio = std::max(previous_difference_ / difference, smallest_ratio);
    return std::max({difference, difference / (ratio - 1.0), previous_difference_ / expected_ratio});
  }

  ConvergedRun take() { return std::move(result_); }

 private:
  const Integrator& integrator_;
  const Ivp& ivp_;
  const std::function<double(ConstVectorRef)>& norm_;
  const RefinementGoal& goal_;
  ConvergedRun result_;
  double previous_difference_ = std::numeric_limits<double>::infinity();
};

}  // namespace

ConvergedRun run_to_accuracy(const Integrator& integrator, const Ivp& ivp,
                             const std::function<double(ConstVectorRef difference)>& norm,
                             const RefinementGoal& goal, bool prefers_constant_steps) {
  const MethodInfo& info = integrator.info();
  Refinement refinement(integrator, ivp, norm, goal);
  if (info.has_fixed_step && (prefers_constant_steps || !info.is_adaptive)) {
    // Four times the ratio that the order lets expect: symmetric schemes are better than their order at
    // times.
    const double expected_ratio = std::pow(2.0, std::max(info.order, 1) + 2);
    for (std::uint64_t steps = goal.fewest_steps; steps <= goal.most_steps; steps *= 2) {
      const double step = (ivp.t1 - ivp.t0) / static_cast<double>(steps);
      if (!refinement.refine(FixedStep{.step = step, .allow_short_last_step = false}, expected_ratio)) break;
    }
  } else {
    // With tolerances on each step the error falls like tolerance^(p/(p + 1)): by √10 at least, with order 1.
    const double expected_ratio = std::sqrt(10.0);
    // An error estimate can be blind for a problem or a controller erratic: the largest step shrinks along.
    double largest_step = (ivp.t1 - ivp.t0) / static_cast<double>(goal.fewest_steps);
    // The last tolerance is reached exactly, rounding of the powers aside.
    for (double tolerance = goal.first_tolerance; tolerance >= 0.9 * goal.smallest_tolerance;
         tolerance /= 10.0, largest_step /= 2.0) {
      const AdaptiveStep control{.relative_tolerance = tolerance,
                                 .absolute_tolerance = tolerance * goal.absolute_over_relative,
                                 .maximum_step = largest_step,
                                 .maximum_steps = 16 * goal.most_steps};
      if (!refinement.refine(control, expected_ratio)) break;
    }
  }
  return refinement.take();
}

}  // namespace fw::analysis
