#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "analysis/fit/power_law.hpp"
#include "analysis/theory/stiffness_measures.hpp"
#include "core/special_values.hpp"
#include "schemes/derived_properties.hpp"
#include "study/measure/error_meter.hpp"
#include "study/measure/step_ladder.hpp"
#include "study/stiffness/stiffness_cases.hpp"

namespace fw::study {

namespace {

/// For eigenvalues that are a whole range apart but for rounding.
constexpr double range_slack = 1.02;

/// The cheapest run found that reaches the target on one member, or why there is none.
struct Found {
  bool reached = false;
  double step = no_value, tolerance = no_value, error = no_value;
  double largest_eigenvalue = no_value;
  /// Factor between the work of this run and of the cheapest one known not to reach the target: how well the
  /// cost is known.
  double bracket = 1.0;
  /// Whether there is such a run: the coarsest one may do, and then its steps are no measure of anything.
  bool is_bracketed() const { return bracket > 1.0; }
  Work work;
  Timing timing;
  std::string status = "success";
};

/// Of the finite ones.
double median(std::vector<double> samples) {
  std::erase_if(samples, [](double sample) { return !std::isfinite(sample); });
  if (samples.empty()) return no_value;
  std::sort(samples.begin(), samples.end());
  return samples[samples.size() / 2];
}

class CostCase {
 public:
  CostCase(const StiffnessFamily& family, const StiffnessMethod& method, const StiffnessSettings& settings,
           const RunContext& context)
      : family_(family), method_(method), settings_(settings), context_(context) {}

  CaseResult run() {
    const std::string why = why_not_applicable(info(), *family_.members.front()->ivp().system);
    if (!why.empty()) return conclude(Verdict::not_applicable, why);
    for (const auto& member : family_.members) found_.push_back(search(*member));
    return judge();
  }

 private:
  const MethodInfo& info() const { return method_.integrator->info(); }

  Found search(const SharedProblem& member) const {
    Found found;
    const ErrorMeter meter(member, context_);
    if (!meter.status().ok()) {
      found.status = meter.status().describe();
      return found;
    }
    if (meter.floor() > settings_.target_error) {
      found.status = fmt::format("the reference is known to {:.2g} only", meter.floor());
      return found;
    }
    found.largest_eigenvalue =
        analysis::stiffness_measures(*member.ivp().system, member.ivp().t0, member.ivp().y0)
            .largest_eigenvalue;
    if (info().is_adaptive) {
      search_tolerance(member.ivp(), meter, found);
    } else {
      search_steps(member.ivp(), meter, found);
    }
    return found;
  }

  /// The run, if it reaches the target.
  std::optional<Found> try_run(const Ivp& ivp, const ErrorMeter& meter, const StepControl& control,
                               Found& outcome) const {
    const Solution solution = run_once(*method_.integrator, ivp, control, context_);
    outcome.status =
        solution.status.ok() ? "accuracy_not_reached" : std::string(to_string(solution.status.code));
    if (!solution.status.ok()) return std::nullopt;
    const double error = meter.error(solution.state);
    if (!(error <= settings_.target_error)) return std::nullopt;
    Found found;
    found.reached = true;
    found.error = error;
    found.work = solution.work;
    found.largest_eigenvalue = outcome.largest_eigenvalue;
    return found;
  }

  std::int64_t most_steps() const { return affordable_steps(info(), settings_.max_evaluations); }

  /// Doubles the number of steps until the target is reached, then halves the gap on the logarithmic axis.
  void search_steps(const Ivp& ivp, const ErrorMeter& meter, Found& found) const {
    const auto control = [&ivp](std::int64_t steps) { return constant_steps(ivp, steps); };
    DoubledSteps<Found> doubled = double_steps(settings_.fewest_steps, most_steps(), [&](std::int64_t steps) {
      return try_run(ivp, meter, control(steps), found);
    });
    if (!doubled.run) return;
    std::int64_t failing = doubled.rejected, reaching = doubled.steps;
    while (failing > 0 && static_cast<double>(reaching) > settings_.bracket * static_cast<double>(failing)) {
      const auto middle = static_cast<std::int64_t>(
          std::llround(std::sqrt(static_cast<double>(failing) * static_cast<double>(reaching))));
      if (middle <= failing || middle >= reaching) break;
      if (std::optional<Found> finer = try_run(ivp, meter, control(middle), found)) {
        doubled.run = std::move(finer);
        reaching = middle;
      } else {
        failing = middle;
      }
    }
    found = std::move(*doubled.run);
    if (failing > 0) found.bracket = static_cast<double>(reaching) / static_cast<double>(failing);
    found.step = control(reaching).step;
    measure(ivp, control(reaching), found);
  }

  void search_tolerance(const Ivp& ivp, const ErrorMeter& meter, Found& found) const {
    for (double tolerance = settings_.first_tolerance; tolerance >= 0.999 * settings_.smallest_tolerance;
         tolerance /= settings_.tolerance_ratio) {
      const AdaptiveStep control = chosen_steps(tolerance, settings_.absolute_over_relative, most_steps());
      std::optional<Found> best = try_run(ivp, meter, control, found);
      if (!best) continue;
      found = std::move(*best);
      found.tolerance = tolerance;
      // One tolerance coarser would do with about this much less: steps ~ tolerance^(−1/(p + 1)), p ≥ 1.
      found.bracket = std::sqrt(settings_.tolerance_ratio);
      measure(ivp, control, found);
      return;
    }
  }

  void measure(const Ivp& ivp, const StepControl& control, Found& found) const {
    found.timing =
        time_run(*method_.integrator, ivp, control, found.work.seconds, settings_.timing, context_);
    found.status = "success";
  }

  double steps_of(const Found& found) const {
    return static_cast<double>(found.work.accepted_steps + found.work.rejected_steps);
  }

  /// "implicit": solves equations with a Jacobian; "exponential": explicit, but A-stable by functions of the
  /// Jacobian; "explicit": all others. A multistep formula that is iterated without a Jacobian, as in Adams
  /// codes, is limited like an explicit one; a Verlet scheme stays explicit where a damper needs a solve.
  std::string stepping() const {
    if (info().is_explicit) return info().is_a_stable ? "exponential" : "explicit";
    const bool uses_jacobian =
        found_.empty() || std::any_of(found_.begin(), found_.end(), [](const Found& found) {
          const Work& work = found.work;
          return work.jacobian_evaluations + work.jacobian_products + work.factorisations +
                     work.linear_solves >
                 0;
        });
    return uses_jacobian ? "implicit" : "explicit";
  }

  /// The bounded stability interval on the imaginary axis that limits h|λ|, as far as coefficients tell; else NaN.
  double stability_interval() const {
    if (!info().is_explicit || std::holds_alternative<std::monostate>(method_.data)) return no_value;
    const schemes::DerivedProperties properties = schemes::derive(method_.data);
    const auto is_bounded = [](double interval) { return interval > 0.0 && std::isfinite(interval); };
    if (properties.stability && is_bounded(properties.stability->imaginary_interval)) {
      return properties.stability->imaginary_interval;
    }
    return properties.oscillator && is_bounded(properties.oscillator->interval)
               ? properties.oscillator->interval
               : no_value;
  }

  CaseResult judge() {
    // The stiffest members, where stability rather than accuracy limits an explicit step.
    double most = 0.0;
    for (const Found& found : found_) {
      if (std::isfinite(found.largest_eigenvalue)) most = std::max(most, found.largest_eigenvalue);
    }
    std::vector<double> eigenvalues, steps;
    double last_product = no_value;  // of the stiffest one: families rise
    double least_product = std::numeric_limits<double>::infinity();
    double least_at_once = least_product;  // of those that the first run serves
    for (std::size_t k = 0; k < found_.size(); ++k) {
      const double eigenvalue = found_[k].largest_eigenvalue;
      if (!found_[k].reached || !(eigenvalue * settings_.fit_range * range_slack >= most)) continue;
      eigenvalues.push_back(eigenvalue);
      steps.push_back(steps_of(found_[k]));
      const Ivp& ivp = family_.members[k]->ivp();
      last_product = (ivp.t1 - ivp.t0) / steps.back() * eigenvalue;
      least_product = std::min(least_product, last_product);
      if (!found_[k].is_bracketed()) least_at_once = std::min(least_at_once, last_product);
    }
    const auto reached =
        std::count_if(found_.begin(), found_.end(), [](const Found& f) { return f.reached; });
    const std::string coverage =
        fmt::format("error {:g} reached at {} of {} values", settings_.target_error, reached, found_.size());
    law_ = analysis::fit_power_law(eigenvalues, steps);
    if (!law_.valid) return conclude(Verdict::not_applicable, coverage + "; " + law_.reason);
    const std::string found = fmt::format(
        "{}; steps ~ |lambda|^{:.3f} [{:.3f}, {:.3f}] over the largest {} values, mean h|lambda| = {:.3g} at "
        "the last",
        coverage, law_.exponent, law_.exponent_low, law_.exponent_high, law_.points, last_product);
    // Steps of its own choice end near the limit of stability, but at no exact distance from it.
    const double interval = stability_interval();
    if (info().is_adaptive || std::isnan(interval)) return conclude(Verdict::not_applicable, found);
    const double tolerance = settings_.exponent_tolerance;
    const std::string claim =
        fmt::format("{}, predicted 1 within {:g}: the stability interval limits h|lambda|", found, tolerance);
    // Where stability limits the step it ends near the end of the interval. Without a coarser run that misses the
    // target it may also end beyond: vibrations that nothing excites take many steps to grow out of rounding, but
    // few at ten times the interval.
    constexpr double share = 0.3, beyond = 10.0;
    if (!(least_product >= share * interval)) {
      return conclude(
          Verdict::not_applicable,
          fmt::format("{}; not here, where accuracy does: it is {:.3g} at the least, {:.3g} are stable",
                      claim, least_product, interval));
    }
    if (least_at_once <= beyond * interval) {
      return conclude(Verdict::not_applicable,
                      claim + "; not decided, since no coarser run is known to miss the target");
    }
    if (analysis::judge_exponent(law_, 1.0, tolerance) == analysis::LawJudgement::supported) {
      return conclude(Verdict::holds, claim);
    }
    // In between both limit the step, and the exponent is nobody's.
    constexpr double at_the_end = 0.8;
    const bool is_refuted = least_product >= at_the_end * interval &&
                            (law_.exponent_low > 1.0 + tolerance || law_.exponent_high < 1.0 - tolerance);
    return conclude(is_refuted ? Verdict::fails : Verdict::not_applicable,
                    is_refuted ? claim : claim + "; not decided");
  }

  CaseResult conclude(Verdict verdict, std::string reason) const {
    StiffnessRow row{.problem = family_.label,
                     .method = method_.call,
                     .measure = measures_cost,
                     .stepping = stepping(),
                     .parameter = family_.parameter,
                     .classical_order = info().order};
    row.points = static_cast<std::int64_t>(
        std::count_if(found_.begin(), found_.end(), [](const Found& f) { return f.reached; }));
    if (law_.valid) row.step_exponent = {law_.exponent, law_.exponent_low, law_.exponent_high};
    return case_result(verdict, std::move(reason), columns(), row);
  }

  std::vector<Column> columns() const {
    std::vector<double> parameter, eigenvalue, step, tolerance, error, cost, cost_spread, seconds,
        seconds_spread, samples;
    std::vector<std::string> status;
    std::vector<Work> work;
    OperationCosts dearer = settings_.costs;
    for (double* each : {&dearer.jacobian, &dearer.jacobian_product, &dearer.factorisation,
                         &dearer.linear_solve, &dearer.linear_iteration}) {
      *each *= settings_.cost_uncertainty;
    }
    for (std::size_t k = 0; k < found_.size(); ++k) {
      const Found& found = found_[k];
      parameter.push_back(family_.values[k]);
      eigenvalue.push_back(found.largest_eigenvalue);
      step.push_back(found.step);
      tolerance.push_back(found.tolerance);
      error.push_back(found.error);
      status.push_back(found.status);
      work.push_back(found.work);
      const double own = settings_.costs.of(found.work);
      cost.push_back(found.reached ? own : no_value);
      cost_spread.push_back(found.reached ? found.bracket * dearer.of(found.work) / own : no_value);
      seconds.push_back(found.reached ? found.timing.minimum : no_value);
      std::vector<double> taken = found.timing.samples;
      taken.resize(static_cast<std::size_t>(settings_.timing.repetitions), no_value);
      seconds_spread.push_back(found.reached ? found.bracket * median(taken) / found.timing.minimum
                                             : no_value);
      samples.insert(samples.end(), taken.begin(), taken.end());
    }
    std::vector<Column> columns = {{"parameter", "SI", parameter, {}, {{"name", family_.parameter}}},
                                   {"largest_eigenvalue", "1/s", eigenvalue, {}, {}},
                                   {"step", "s", step, {}, {}},
                                   {"tolerance", "1", tolerance, {}, {}},
                                   {"error", "1", error, {}, {}},
                                   {"status", "", status, {}, {}}};
    add_work_columns(columns, work);
    columns.push_back({"cost", "1", cost, {}, {}});
    columns.push_back({"cost_spread", "1", cost_spread, {}, {}});
    columns.push_back({"seconds", "s", seconds, {}, {}});
    columns.push_back({"seconds_spread", "1", seconds_spread, {}, {}});
    columns.push_back({"seconds_samples",
                       "s",
                       samples,
                       {found_.size(), static_cast<std::uint64_t>(settings_.timing.repetitions)},
                       {}});
    return columns;
  }

  const StiffnessFamily& family_;
  const StiffnessMethod& method_;
  const StiffnessSettings& settings_;
  const RunContext& context_;
  std::vector<Found> found_;
  analysis::PowerLaw law_;
};

}  // namespace

CaseResult run_stiffness_cost(const StiffnessFamily& family, const StiffnessMethod& method,
                              const StiffnessSettings& settings, const RunContext& context) {
  return CostCase(family, method, settings, context).run();
}

}  // namespace fw::study
