#include "study/work_precision/work_precision_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "analysis/fit/efficiency.hpp"
#include "analysis/fit/order_fit.hpp"
#include "analysis/fit/power_law.hpp"
#include "analysis/theory/linear_modes.hpp"
#include "analysis/theory/stiffness_measures.hpp"
#include "core/special_values.hpp"
#include "study/measure/error_meter.hpp"
#include "study/measure/step_ladder.hpp"
#include "study/measure/work_columns.hpp"

namespace fw::study {

namespace {

/// Local slopes in the fit differ from the finest ones by no more.
constexpr double slope_tolerance = 0.1;
/// Evaluations per step count as constant where the largest is at most this much above the smallest.
constexpr double constant_work = 1.05;
/// h|λ| above which a step does not resolve the fastest motion.
constexpr double largest_resolved_product = 0.5;

/// One run of the ladder.
struct Rung {
  double control = 0.0;  ///< step [s] or relative tolerance
  double error = 0.0;    ///< relative
  Work work;
  Timing timing;
};

double evaluations_of(const Rung& rung) {
  return static_cast<double>(rung.work.rhs_evaluations);
}

/// The cells of every row: of a ladder, or of a front with what does not apply left empty.
struct Row {
  std::string problem, method, family, control;
  std::int64_t expected_order = 0;
  analysis::OrderFit fit{};
  double smallest_error = no_value, evaluations_at_target = no_value, seconds_at_target = no_value;
  std::int64_t points_on_front_evaluations = 0, points_on_front_seconds = 0;
};

void declare(SummaryRow& a, const Row& row) {
  const bool valid = row.fit.valid;
  a("problem", "", row.problem, "its label");
  a("method", "", row.method, "as in the study; `Pareto front`");
  a("family", "", row.family, "as in `federwerk list methods`; empty of fronts");
  a("control", "", row.control, "`fixed` or `adaptive`; empty of fronts");
  a("expected_order", "1", row.expected_order, "by theory; 0: variable");
  a("efficiency_order", "1", valid ? row.fit.order : no_value,
    "p of error ~ right-hand sides^-p; NaN where there is no fit");
  a("efficiency_order_low", "1", valid ? row.fit.order_low : no_value, "lower end of the 95 % interval");
  a("efficiency_order_high", "1", valid ? row.fit.order_high : no_value, "upper end");
  a("correlation", "1", valid ? row.fit.correlation : no_value, "of the fit");
  a("points", "1", static_cast<std::int64_t>(row.fit.points), "in the fit");
  a("smallest_error", "1", row.smallest_error, "of the ladder");
  a("rhs_evaluations_at_target", "1", row.evaluations_at_target,
    "that the target error costs, interpolated; NaN where it is not reached");
  a("seconds_at_target", "s", row.seconds_at_target, "likewise");
  a("front_points_rhs_evaluations", "1", row.points_on_front_evaluations,
    "points of the ladder on the front; of fronts: all");
  a("front_points_seconds", "1", row.points_on_front_seconds, "likewise by seconds");
}

/// A ladder as it is run.
class Ladder {
 public:
  Ladder(const WorkPrecisionSpec& spec, const RunContext& context)
      : spec_(spec), settings_(spec.settings), context_(context) {}

  CaseResult run() {
    const std::string why = why_not_applicable(spec_.integrator->info(), *ivp().system);
    if (!why.empty()) return conclude(why);
    meter_.emplace(*spec_.problem, context_);
    if (!meter_->status().ok()) return conclude(meter_->status().describe());
    if (spec_.control == LadderControl::fixed) {
      climb_steps();
    } else {
      climb_tolerances();
    }
    return judge();
  }

 private:
  const Ivp& ivp() const { return spec_.problem->ivp(); }
  double length() const { return ivp().t1 - ivp().t0; }
  const MethodInfo& info() const { return spec_.integrator->info(); }

  std::int64_t expected_order() const { return order_on(info(), *ivp().system); }

  /// A run without its timing; empty if it failed numerically.
  std::optional<Rung> try_run(const StepControl& control, double number) {
    const Solution solution = run_once(*spec_.integrator, ivp(), control, context_);
    last_status_ = solution.status;
    if (!solution.status.ok()) return std::nullopt;
    Rung rung{.control = number, .error = 0.0, .work = solution.work, .timing = {}};
    rung.error = meter_->error(solution.state);
    if (!std::isfinite(rung.error)) return std::nullopt;
    return rung;
  }

  void keep(Rung rung, const StepControl& control) {
    rung.timing = time_run(*spec_.integrator, ivp(), control, rung.work.seconds, settings_.timing, context_);
    rungs_.push_back(std::move(rung));
  }

  /// Whether another rung, with `factor` times the work, is not wanted.
  bool is_top(double factor) const {
    const double factorisations = static_cast<double>(rungs_.back().work.factorisations);
    return is_fine_enough() || factor * factorisations > static_cast<double>(settings_.max_factorisations);
  }

  bool is_fine_enough() const {
    return rungs_.back().error < std::max(settings_.finest_error, meter_->floor());
  }

  std::int64_t most_steps() const { return affordable_steps(info(), settings_.max_evaluations); }

  void climb_steps() {
    const DoubledSteps<Rung> coarsest =
        double_steps(settings_.fewest_steps, most_steps(), [this](std::int64_t steps) {
          std::optional<Rung> rung = try_run(constant_steps(ivp(), steps), 0.0);
          if (rung && !(rung->error <= settings_.start_error)) rung.reset();
          return rung;
        });
    if (!coarsest.run) return;
    for (const LadderStep& level :
         step_ladder(coarsest.steps, settings_.step_ratio, settings_.levels, most_steps())) {
      const FixedStep control = constant_steps(ivp(), level.steps);
      std::optional<Rung> rung = try_run(control, control.step);
      if (!rung) continue;
      if (rung->work.rhs_evaluations > static_cast<std::uint64_t>(settings_.max_evaluations)) break;
      keep(std::move(*rung), control);
      if (is_top(settings_.step_ratio)) break;
    }
  }

  void climb_tolerances() {
    for (std::int64_t k = 0; k < settings_.levels; ++k) {
      const double tolerance =
          settings_.first_tolerance / std::pow(settings_.tolerance_ratio, static_cast<double>(k));
      if (tolerance < 0.999 * settings_.smallest_tolerance) break;
      const AdaptiveStep control = chosen_steps(tolerance, settings_.absolute_over_relative, most_steps());
      std::optional<Rung> rung = try_run(control, tolerance);
      if (!rung && last_status_.code == StatusCode::step_limit) break;  // a tighter one needs even more
      if (!rung) continue;
      if (rung->work.rhs_evaluations > static_cast<std::uint64_t>(settings_.max_evaluations)) break;
      keep(std::move(*rung), control);
      if (is_top(1.0)) break;
    }
  }

  /// The largest quotient of evaluations per step among the points of the fit.
  double spread_of_work() const {
    double least = std::numeric_limits<double>::infinity(), most = 0.0;
    for (std::size_t k = 0; k < rungs_.size(); ++k) {
      if (fit_.used[k] == 0) continue;
      const double per_step = evaluations_of(rungs_[k]) / static_cast<double>(rungs_[k].work.accepted_steps);
      least = std::min(least, per_step);
      most = std::max(most, per_step);
    }
    return most / least;
  }

  /// h|λ| of the largest step in the fit, with the Jacobian's spectral radius at the start.
  double largest_product() const {
    double step = 0.0;
    for (std::size_t k = 0; k < rungs_.size(); ++k) {
      if (fit_.used[k] != 0) step = std::max(step, rungs_[k].control);
    }
    return step * analysis::spectral_radius(*ivp().system, ivp().t0, ivp().y0);
  }

  CaseResult judge() {
    if (rungs_.empty()) {
      return conclude(
          fmt::format("no run within {} right-hand sides has a relative error below {:g}: {}",
                      settings_.max_evaluations, settings_.start_error,
                      last_status_.ok() ? "the finest run ends with a larger one" : last_status_.describe()));
    }
    std::vector<double> inverse_work, errors;
    for (const Rung& rung : rungs_) {
      inverse_work.push_back(1.0 / evaluations_of(rung));
      errors.push_back(rung.error <= settings_.fit_error ? rung.error : no_value);
    }
    fit_ = analysis::fit_order(inverse_work, errors, meter_->floor(), slope_tolerance);
    if (!fit_.valid) return conclude(fmt::format("no efficiency order: {}", fit_.reason));
    const std::string found = fmt::format("error ~ evaluations^-{:.3f} [{:.3f}, {:.3f}]", fit_.order,
                                          fit_.order_low, fit_.order_high);
    if (spec_.control == LadderControl::adaptive) {
      return conclude(found + "; steps of its own choice, for which theory predicts no exact power");
    }
    const double spread = spread_of_work();
    if (spread > constant_work) {
      return conclude(
          fmt::format("{}; evaluations per step vary by a factor of {:.2f}, for which theory predicts no "
                      "exact power",
                      found, spread));
    }
    const double product = largest_product();
    if (!(product <= largest_resolved_product)) {
      return conclude(fmt::format(
          "{}; h|lambda| is up to {:.3g} in the fit, and theory predicts a power for small steps only", found,
          product));
    }
    const double excess = fit_.order - static_cast<double>(expected_order());
    if (excess > settings_.tolerance && analysis::is_linear(*ivp().system, ivp().t0, ivp().y0)) {
      return conclude(
          fmt::format("{}, above {}: superconvergence on a linear problem", found, expected_order()));
    }
    const std::string claim =
        fmt::format("{}, predicted {} within {:g}", found, expected_order(), settings_.tolerance);
    const auto predicted = static_cast<double>(expected_order());
    if (std::abs(excess) <= settings_.tolerance) {
      const double farthest = std::max(predicted - fit_.order_low, fit_.order_high - predicted);
      return farthest <= std::max(settings_.tolerance, analysis::decisive_distance)
                 ? conclude(claim, Verdict::holds)
                 : conclude(claim + "; not decided: the interval is too wide");
    }
    const bool is_refuted =
        fit_.order_low > predicted + settings_.tolerance || fit_.order_high < predicted - settings_.tolerance;
    return is_refuted ? conclude(claim, Verdict::fails)
                      : conclude(claim + "; not decided: the interval reaches into the tolerance");
  }

  CaseResult conclude(std::string reason, Verdict verdict = Verdict::not_applicable) const {
    Row row{.problem = spec_.problem->entry().label,
            .method = spec_.call,
            .family = info().family,
            .control = to_string(spec_.control),
            .expected_order = expected_order(),
            .fit = fit_};
    std::vector<double> errors, evaluations, seconds;
    for (const Rung& rung : rungs_) {
      errors.push_back(rung.error);
      evaluations.push_back(evaluations_of(rung));
      seconds.push_back(rung.timing.minimum);
    }
    if (!errors.empty()) row.smallest_error = *std::min_element(errors.begin(), errors.end());
    row.evaluations_at_target = analysis::cost_at_error(evaluations, errors, settings_.target_error);
    row.seconds_at_target = analysis::cost_at_error(seconds, errors, settings_.target_error);
    return case_result(verdict, std::move(reason), columns(), row);
  }

  std::vector<Column> columns() const {
    std::vector<double> step, tolerance, error, seconds, samples;
    std::vector<Work> work;
    const bool is_fixed = spec_.control == LadderControl::fixed;
    for (const Rung& rung : rungs_) {
      step.push_back(is_fixed ? rung.control : no_value);
      tolerance.push_back(is_fixed ? no_value : rung.control);
      error.push_back(rung.error);
      work.push_back(rung.work);
      seconds.push_back(rung.timing.minimum);
      samples.insert(samples.end(), rung.timing.samples.begin(), rung.timing.samples.end());
    }
    std::vector<std::int64_t> used(rungs_.size(), 0);
    if (!fit_.used.empty()) std::copy(fit_.used.begin(), fit_.used.end(), used.begin());
    std::vector<Column> columns = {
        {"step", "s", step, {}, {}},
        {"tolerance", "1", tolerance, {}, {}},
        {"error", "1", error, {}, {{"norm", meter_ ? meter_->norm() : "there is no reference"}}},
        {"used", "1", used, {}, {}}};
    add_work_columns(columns, work);
    columns.push_back({"seconds", "s", seconds, {}, {}});
    columns.push_back({"seconds_samples",
                       "s",
                       samples,
                       {rungs_.size(), static_cast<std::uint64_t>(settings_.timing.repetitions)},
                       {}});
    return columns;
  }

  const WorkPrecisionSpec& spec_;
  const WorkPrecisionSettings& settings_;
  const RunContext& context_;
  std::optional<ErrorMeter> meter_;
  std::vector<Rung> rungs_;
  Status last_status_;
  analysis::OrderFit fit_;
};

}  // namespace

std::vector<SummaryColumn> work_precision_summary() {
  return columns_of<Row>();
}

std::string to_string(LadderControl control) {
  return control == LadderControl::fixed ? "fixed" : "adaptive";
}

CaseResult run_work_precision(const WorkPrecisionSpec& spec, const RunContext& context) {
  return Ladder(spec, context).run();
}

CaseResult empty_front(const StudyProblem& problem) {
  CaseResult result;
  for (const auto& [name, unit] : {std::pair{"rhs_evaluations", "1"}, {"seconds", "s"}}) {
    const std::string prefix = std::string("front_") + name;
    result.columns.push_back({prefix, unit, std::vector<double>{}, {}, {}});
    result.columns.push_back({prefix + "_error", "1", std::vector<double>{}, {}, {}});
    result.columns.push_back({prefix + "_method", "", std::vector<std::string>{}, {}, {}});
    result.columns.push_back({prefix + "_control", "", std::vector<std::string>{}, {}, {}});
  }
  result.reason = "the fronts are drawn at the end of the study";
  result.summary =
      cells_of(Row{.problem = problem.label, .method = front_method, .family = "", .control = ""});
  return result;
}

}  // namespace fw::study
