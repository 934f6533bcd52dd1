#include "study/kinds/convergence_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "analysis/fit/order_fit.hpp"
#include "study/measure/error_meter.hpp"
#include "study/measure/step_ladder.hpp"
#include "study/measure/timed_run.hpp"

namespace fw::study {

namespace {

using settings::Archive;
using settings::setting;

/// One run at one step.
struct Level {
  double step = 0.0;
  StateError error;
  Work work;
};

/// Local slopes in the fit differ from the finest ones by no more than half of what a verdict tolerates.
constexpr double slope_tolerance = 0.05;

/// The case problem × method.
class ConvergenceCase {
 public:
  ConvergenceCase(const SharedProblem& problem, std::string call, const Integrator& integrator,
                  ConvergenceSettings settings, const RunContext& context)
      : shared_(problem),
        problem_(problem.entry()),
        call_(std::move(call)),
        integrator_(integrator),
        settings_(settings),
        context_(context) {}

  CaseResult run() {
    if (const std::string why = why_not_applicable(integrator_.info(), *ivp().system); !why.empty()) {
      return conclude(Verdict::not_applicable, why);
    }
    meter_.emplace(shared_, context_);
    if (!meter_->status().ok()) return conclude(Verdict::not_applicable, meter_->status().describe());
    const DoubledSteps<Level> coarsest = find_coarsest();
    if (!coarsest.run) {
      const bool stopped = have_stopped_falling(searched_, meter_->floor()) && !has_kinks();
      return conclude(stopped ? Verdict::fails : Verdict::not_applicable,
                      fmt::format("no step down to {:.3g} gives a relative error below {:g}: {}", last_step_,
                                  settings_.start_error,
                                  stopped             ? "errors stop falling"
                                  : last_status_.ok() ? "the finest run ends with a larger one"
                                                      : last_status_.describe()));
    }
    refine(coarsest.steps);
    return judge();
  }

 private:
  const Ivp& ivp() const { return problem_.problem.ivp; }
  double length() const { return ivp().t1 - ivp().t0; }
  bool is_second_order() const { return ivp().system->second_order() != nullptr; }

  /// Ones where there is no reference.
  StateScale scale() const { return meter_ ? meter_->scale() : StateScale{}; }

  int expected_order() const { return order_on(integrator_.info(), *ivp().system); }

  /// Runs `steps` steps; empty if the run failed numerically.
  std::optional<Level> run_level(std::int64_t steps) {
    const FixedStep control = constant_steps(ivp(), steps);
    const Solution solution = run_once(integrator_, ivp(), control, context_);
    last_status_ = solution.status;
    last_step_ = control.step;
    if (!solution.status.ok()) return std::nullopt;
    return Level{.step = control.step, .error = meter_->measure(solution.state), .work = solution.work};
  }

  /// The coarsest level: the number of steps is doubled until the relative error is small.
  DoubledSteps<Level> find_coarsest() {
    return double_steps(8, settings_.max_steps, [this](std::int64_t steps) {
      std::optional<Level> level = run_level(steps);
      if (level) searched_.push_back({level->step, level->error.relative});
      if (level && !(level->error.relative <= settings_.start_error)) level.reset();
      return level;
    });
  }

  void refine(std::int64_t coarsest) {
    // Where the asymptotic range begins later, as many levels again may be spent on finding it.
    for (const LadderStep& rung :
         step_ladder(coarsest, settings_.ratio, 2 * settings_.levels, settings_.max_steps)) {
      if (rung.level >= settings_.levels && is_measured()) break;
      std::optional<Level> level = run_level(rung.steps);
      if (!level) continue;
      levels_.push_back(std::move(*level));
      // Two levels below the floor show it; more would only cost.
      const std::size_t n = levels_.size();
      const double floor = meter_->floor();
      if (n >= 2 && levels_[n - 1].error.relative < floor && levels_[n - 2].error.relative < floor) break;
    }
  }

  bool has_kinks() const { return !problem_.problem.is_smooth; }

  /// Whether no step has an error that stands out of rounding.
  bool is_exact() const {
    return !levels_.empty() && !meter_->is_limited_by_reference() &&
           std::all_of(levels_.begin(), levels_.end(),
                       [&](const Level& level) { return level.error.relative < meter_->floor(); });
  }

  struct ErrorAtStep {
    double step, error;
  };

  /// Whether errors clear of the floor have stopped falling: from three steps on, the finest two slopes are below ½.
  static bool have_stopped_falling(const std::vector<ErrorAtStep>& errors, double floor) {
    const std::size_t n = errors.size();
    if (n < 3 || !(errors[n - 1].error > 10.0 * floor)) return false;
    for (std::size_t k = n - 2; k < n; ++k) {
      const double slope =
          std::log(errors[k - 1].error / errors[k].error) / std::log(errors[k - 1].step / errors[k].step);
      if (!(slope < 0.5)) return false;
    }
    return true;
  }

  std::vector<ErrorAtStep> errors_of(double StateError::*quantity) const {
    std::vector<ErrorAtStep> errors;
    for (const Level& level : levels_) errors.push_back({level.step, level.error.*quantity});
    return errors;
  }

  bool is_measured() const {
    if (!is_second_order()) return fit(&StateError::relative, 1.0).valid;
    return fit(&StateError::position, scale().position).valid &&
           fit(&StateError::velocity, scale().velocity).valid;
  }

  analysis::OrderFit fit(double StateError::*quantity, double scale) const {
    std::vector<double> steps, errors;
    for (const Level& level : levels_) {
      steps.push_back(level.step);
      errors.push_back(level.error.*quantity);
    }
    return analysis::fit_order(steps, errors, meter_->floor_at(scale), slope_tolerance);
  }

  CaseResult judge() {
    fit_ = fit(&StateError::relative, 1.0);
    if (is_second_order()) {
      fit_position_ = fit(&StateError::position, scale().position);
      fit_velocity_ = fit(&StateError::velocity, scale().velocity);
    }
    if (is_exact()) {
      return conclude(
          Verdict::not_applicable,
          fmt::format("exact on this problem: the errors of all {} steps are below the rounding of {:.1e}",
                      levels_.size(), meter_->floor()));
    }
    std::string reason;
    bool holds = true, refuted = false, measured = true, has_order = false;
    std::string higher;  // halves whose order is above the claimed one
    const auto check = [&](const char* what, const analysis::OrderFit& order_fit,
                           double StateError::*quantity, double size) {
      if (!reason.empty()) reason += "; ";
      if (!order_fit.valid) {
        const std::vector<ErrorAtStep> errors = errors_of(quantity);
        const double floor = meter_->floor_at(size);
        if (std::all_of(errors.begin(), errors.end(),
                        [&](const ErrorAtStep& at) { return at.error < 10.0 * floor; })) {
          reason +=
              fmt::format("{}: exact on this problem", what);  // says nothing against the order of the rest
          return;
        }
        const bool stopped = have_stopped_falling(errors, floor);
        reason += fmt::format("{}: {}{}", what, stopped ? "errors stop falling; " : "", order_fit.reason);
        refuted = refuted || stopped;
        measured = false;
        return;
      }
      // The interval decides: inside the tolerance the order holds, outside it is refuted, else it is open. Where
      // one half alone is above, terms of its error vanish on this problem: the other half decides, as it does
      // beside one that is exact. (Velocities of symplectic Euler from rest have order 2: a motion from rest that
      // starts half a kick later is the same motion.)
      const bool is_a_law = order_fit.correlation >= settings_.minimum_correlation;
      const double low = expected_order() - settings_.tolerance,
                   high = expected_order() + settings_.tolerance;
      refuted = refuted || !is_a_law || order_fit.order_high < low;
      if (is_a_law && order_fit.order_low > high) {
        higher += fmt::format("{}{}", higher.empty() ? "" : " and ", what);
      } else {
        has_order = true;
        holds = holds && is_a_law && order_fit.order_low >= low && order_fit.order_high <= high;
      }
      reason += fmt::format("{} {:.3f} [{:.3f}, {:.3f}] r = {:.6f}", what, order_fit.order,
                            order_fit.order_low, order_fit.order_high, order_fit.correlation);
    };
    if (is_second_order()) {
      check("position", *fit_position_, &StateError::position, scale().position);
      check("velocity", *fit_velocity_, &StateError::velocity, scale().velocity);
    } else {
      check("state", fit_, &StateError::relative, 1.0);
    }
    if (!higher.empty() && has_order) {
      reason += fmt::format("; terms of the error of the {} vanish on this problem", higher);
    } else if (!higher.empty() && measured) {
      refuted = true;
    }
    if (!measured && meter_->is_limited_by_reference()) {
      return conclude(Verdict::not_applicable, fmt::format("the reference is known to {:.2g} only; {}",
                                                           meter_->reference_error(), reason));
    }
    if (holds && measured && has_order) return conclude(Verdict::holds, reason);
    if (refuted && has_kinks()) {
      return conclude(Verdict::not_applicable, reason + "; forces with kinks lower the order");
    }
    if (refuted) return conclude(Verdict::fails, reason);
    return conclude(
        Verdict::not_applicable,
        reason + (measured && has_order ? "; not decided: the interval reaches beyond the tolerance" : ""));
  }

  CaseResult conclude(Verdict verdict, std::string reason) const {
    return case_result(verdict, std::move(reason), columns(), row());
  }

  std::vector<Column> columns() const {
    std::vector<double> step, position, velocity, relative, seconds, components;
    std::vector<std::int64_t> used, evaluations;
    for (std::size_t k = 0; k < levels_.size(); ++k) {
      const Level& level = levels_[k];
      step.push_back(level.step);
      position.push_back(level.error.position);
      velocity.push_back(level.error.velocity);
      relative.push_back(level.error.relative);
      seconds.push_back(level.work.seconds);
      evaluations.push_back(static_cast<std::int64_t>(level.work.rhs_evaluations));
      used.push_back(fit_.used.empty() ? 0 : fit_.used[k]);
      components.insert(components.end(), level.error.components.begin(), level.error.components.end());
    }
    const auto used_of = [&](const std::optional<analysis::OrderFit>& order_fit) {
      std::vector<std::int64_t> flags(levels_.size(), 0);
      if (order_fit) std::copy(order_fit->used.begin(), order_fit->used.end(), flags.begin());
      return flags;
    };
    const std::string root_mean_square = "root mean square over the components at the end time";
    const auto size = static_cast<std::uint64_t>(ivp().system->size());
    std::vector<Column> columns = {
        {"step", "s", step, {}, {}},
        {"error_position", "m", position, {}, {{"norm", root_mean_square}}},
        {"error_velocity", "m/s", velocity, {}, {{"norm", root_mean_square}}},
        {"error", "1", relative, {}, {{"norm", relative_norm()}}},
        {"used", "1", used, {}, {}},
        {"used_position", "1", used_of(fit_position_), {}, {}},
        {"used_velocity", "1", used_of(fit_velocity_), {}, {}},
        {"error_components",
         "SI",
         components,
         {levels_.size(), size},
         {{"norm", "signed difference per component of the state"}}},
        {"rhs_evaluations", "1", evaluations, {}, {}},
        {"seconds", "s", seconds, {}, {}},
    };
    if (!problem_.scene_toml.empty()) {
      columns.push_back({"scene", "", std::vector<std::string>{problem_.scene_toml}, {}, {}});
    }
    return columns;
  }

  std::string relative_norm() const {
    if (!is_second_order()) return fmt::format("root mean square over the state / {:.6g}", scale().state);
    return fmt::format("sqrt(((error_position / {:.6g} m)^2 + (error_velocity / {:.6g} m/s)^2) / 2)",
                       scale().position, scale().velocity);
  }

  ConvergenceRow row() const {
    const auto figure = [](const std::optional<analysis::OrderFit>& order_fit) {
      RowFit seen;
      if (!order_fit) return seen;
      seen.points = static_cast<std::int64_t>(order_fit->points);
      if (!order_fit->valid) return seen;
      seen.order = order_fit->order;
      seen.order_low = order_fit->order_low;
      seen.order_high = order_fit->order_high;
      seen.correlation = order_fit->correlation;
      return seen;
    };
    ConvergenceRow row{.problem = problem_.label, .method = call_, .expected_order = expected_order()};
    row.all = figure(fit_);
    row.position = figure(fit_position_);
    row.velocity = figure(fit_velocity_);
    if (meter_) row.reference_error = meter_->reference_error();
    return row;
  }

  const SharedProblem& shared_;
  const StudyProblem& problem_;
  std::string call_;
  const Integrator& integrator_;
  ConvergenceSettings settings_;
  const RunContext& context_;
  std::optional<ErrorMeter> meter_;
  std::vector<Level> levels_;
  std::vector<ErrorAtStep> searched_;  ///< of the search for the coarsest step
  double last_step_ = 0.0;
  Status last_status_;
  analysis::OrderFit fit_;
  std::optional<analysis::OrderFit> fit_position_, fit_velocity_;
};

}  // namespace

void declare(Archive& a, ConvergenceSettings& s) {
  a(setting("ratio", s.ratio).unit("1").above(1.0).quick().doc("of successive steps"));
  a(setting("levels", s.levels)
        .integers(6, 100)
        .quick_at_most(6)
        .doc("steps per case; up to twice as many if these do not suffice for a fit"));
  a(setting("start_error", s.start_error)
        .unit("1")
        .positive()
        .doc("relative error at the coarsest step, found by doubling the number of steps from 8"));
  a(setting("max_steps", s.max_steps).integers(100, 10'000'000'000).doc("no run takes more steps"));
  a(setting("tolerance", s.tolerance)
        .unit("1")
        .positive()
        .doc("the 95 % interval of the order has to lie within so much of the expected one"));
  a(setting("minimum_correlation", s.minimum_correlation)
        .unit("1")
        .nonnegative()
        .doc("least correlation that holds"));
}

void declare(SummaryRow& a, const ConvergenceRow& row) {
  a("problem", "", row.problem, "its label");
  a("method", "", row.method, "as in the study, with settings");
  a("expected_order", "1", row.expected_order, "by theory");
  a("order", "1", row.all.order,
    "slope of log `error` over log `step`; NaN where there is no fit, like all that follows");
  a("order_low", "1", row.all.order_low, "lower end of the 95 % interval");
  a("order_high", "1", row.all.order_high, "upper end");
  a("correlation", "1", row.all.correlation, "of the fit");
  a("points", "1", row.all.points, "in the fit; 0 where there is no fit");
  a("order_position", "1", row.position.order, "as `order`, of `error_position`; NaN for y' = f(t, y)");
  a("order_low_position", "1", row.position.order_low, "lower end");
  a("order_high_position", "1", row.position.order_high, "upper end");
  a("correlation_position", "1", row.position.correlation, "of this fit");
  a("points_position", "1", row.position.points, "in this fit");
  a("order_velocity", "1", row.velocity.order, "as `order`, of `error_velocity`; NaN for y' = f(t, y)");
  a("order_low_velocity", "1", row.velocity.order_low, "lower end");
  a("order_high_velocity", "1", row.velocity.order_high, "upper end");
  a("correlation_velocity", "1", row.velocity.correlation, "of this fit");
  a("points_velocity", "1", row.velocity.points, "in this fit");
  a("reference_error", "SI", row.reference_error,
    "bound on the error of the reference solution, largest component; NaN without a reference");
}

CaseResult run_convergence(const SharedProblem& problem, const std::string& call,
                           const Integrator& integrator, const ConvergenceSettings& settings,
                           const RunContext& context) {
  return ConvergenceCase(problem, call, integrator, settings, context).run();
}

}  // namespace fw::study
