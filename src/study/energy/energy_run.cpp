#include "study/energy/energy_run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/fit/power_law.hpp"
#include "core/special_values.hpp"

namespace fw::study {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Statements that hold or fail, each with its figures.
class Findings {
 public:
  void require(bool holds, std::string text) {
    applies_ = true;
    if (!holds) failed_ = true;
    texts_.push_back(holds ? std::move(text) : "FAILS: " + text);
  }
  /// A statement that nothing measured here decides: the case cannot hold.
  void leave_open(const std::string& text) {
    is_open_ = true;
    texts_.push_back(text);
  }
  void note(const std::string& text) { texts_.push_back(text); }

  EnergyVerdict verdict() const {
    return {failed_                 ? Verdict::fails
            : applies_ && !is_open_ ? Verdict::holds
                                    : Verdict::not_applicable,
            fmt::format("{}", fmt::join(texts_, "; "))};
  }

 private:
  bool applies_ = false, failed_ = false, is_open_ = false;
  std::vector<std::string> texts_;
};

/// What rounding may do to sums of numbers of size `magnitude` in n steps: a walk of a few units per step.
double rounding_bound(double magnitude, std::uint64_t steps) {
  return epsilon * magnitude * (50.0 + 20.0 * std::sqrt(static_cast<double>(steps)));
}

/// Of the energy of a run.
double rounding_bound(const EnergyRun& run) {
  return rounding_bound(run.seen->budget().magnitude(), run.seen->steps_taken());
}

/// The same where every step also leaves the equations of a step unsolved by `tolerance`.
double conservation_bound(double rounding, double scale, std::uint64_t steps, double tolerance) {
  return rounding + tolerance * scale * static_cast<double>(steps);
}

std::string how_it_failed(const EnergyRun& run) {
  if (!run.status.ok()) {
    return fmt::format("the run at h = {:.4g} ended at t = {:.4g}: {}", run.step, run.end_time,
                       run.status.describe());
  }
  return fmt::format("the run at h = {:.4g} blows up: its energy grows by the factor {:.3g}", run.step,
                     run.seen->budget().growth_factor());
}

void judge_growth(const std::vector<EnergyRun>& runs, Findings& findings) {
  const EnergyRun* worst = nullptr;
  double ratio = -1.0;
  for (const EnergyRun& run : runs) {
    if (std::isnan(run.predicted_growth)) continue;
    const double difference = std::abs(run.growth - run.predicted_growth);
    const double share = difference <= run.growth_tolerance ? difference / run.growth_tolerance
                                                            : std::max(1.0, difference) * 1e6;
    if (worst == nullptr || !(share <= ratio)) {
      worst = &run;
      ratio = share;
    }
  }
  if (worst == nullptr) return;
  const bool holds = std::abs(worst->growth - worst->predicted_growth) <= worst->growth_tolerance;
  findings.require(
      holds, fmt::format("amplitude grows by the factor 1{:+.6e} per step at h = {:.4g}, predicted 1{:+.6e}",
                         std::expm1(worst->growth), worst->step, std::expm1(worst->predicted_growth)));
}

/// The largest of value/bound over the runs, with the run it belongs to.
template <class Value, class Bound>
void require_bounded(const std::vector<EnergyRun>& runs, Findings& findings, const std::string& what,
                     Value value, Bound bound) {
  const EnergyRun* worst = nullptr;
  for (const EnergyRun& run : runs) {
    if (run.has_blown_up()) continue;
    if (worst == nullptr || !(value(run) / bound(run) <= value(*worst) / bound(*worst))) worst = &run;
  }
  if (worst == nullptr) {
    findings.leave_open(what + " is not judged: every run blows up");
    return;
  }
  findings.require(
      value(*worst) <= bound(*worst),
      fmt::format("{} changes by at most {:.1e} in {} steps (h = {:.4g}), rounding allows {:.1e}", what,
                  value(*worst), worst->seen->steps_taken(), worst->step, bound(*worst)));
}

void judge_momenta(const MethodInfo& info, bool keeps_angular_momentum, const std::vector<EnergyRun>& runs,
                   Findings& findings) {
  const auto momentum_bound = [&](double scale, const EnergyRun& run) {
    const std::uint64_t steps = run.seen->steps_taken();
    return conservation_bound(rounding_bound(scale, steps), scale, steps, info.iteration_tolerance);
  };
  require_bounded(
      runs, findings, "linear momentum",
      [](const EnergyRun& run) { return run.seen->momentum_change()->largest_magnitude(); },
      [&](const EnergyRun& run) { return momentum_bound(run.seen->momentum_scale(), run); });
  const auto angular = [](const EnergyRun& run) { return run.seen->angular_change()->largest_magnitude(); };
  if (keeps_angular_momentum) {
    require_bounded(runs, findings, "angular momentum", angular,
                    [&](const EnergyRun& run) { return momentum_bound(run.seen->angular_scale(), run); });
  } else {
    findings.note(fmt::format("angular momentum changes by {:.1e} of its size at h = {:.4g}",
                              angular(runs.front()) / runs.front().seen->angular_scale(), runs.front().step));
  }
}

/// A trend that stands out of rounding and of its own interval, and has not used up the energy yet.
bool is_clear(const EnergyRun& run) {
  const analysis::Drift& drift = run.drift;
  const double change = std::abs(run.relative_drift());  // NaN beyond 0.2
  return run.status.ok() && drift.valid && drift.slope_low * drift.slope_high > 0.0 &&
         change * run.seen->scale() > 100.0 * rounding_bound(run);
}

void judge_symplectic(const std::vector<EnergyRun>& runs, Findings& findings) {
  const EnergyRun* worst = nullptr;
  bool holds = true;
  for (const EnergyRun& run : runs) {
    const analysis::Drift& drift = run.drift;
    if (run.has_blown_up() || !run.status.ok()) continue;
    // Without an oscillation inside the batches there is nothing to hold a trend against.
    const bool has_short_batches =
        !drift.valid || run.seen->steps_taken() < 2 * static_cast<std::uint64_t>(drift.batches);
    if (has_short_batches) continue;
    const bool within_rounding = std::abs(drift.slope) * drift.duration <= rounding_bound(run);
    const bool fine = within_rounding || !drift.is_significant(runs.size()) || drift.significance() <= 0.1;
    if (worst == nullptr || !fine || (holds && drift.significance() > worst->drift.significance()))
      worst = &run;
    holds = holds && fine;
    if (!fine) break;
  }
  if (worst == nullptr) {
    findings.leave_open(
        "no secular drift is not judged: every run failed, blew up or has too few steps per batch");
    return;
  }
  findings.require(holds,
                   fmt::format("no secular drift: {:.2g} of the oscillation over {} steps at h = {:.4g}",
                               worst->drift.significance(), worst->steps, worst->step));
}

/// Statements about powers of h allow this much below the power.
constexpr double exponent_tolerance = 0.3;

/// "falls with h^p or a higher power": decided by the interval of the exponent, which needs three points.
void judge_exponent(const char* what, const StepExponent& exponent, int order, bool has_kinks,
                    std::size_t runs, Findings& findings) {
  if (runs < 3) {
    findings.note(fmt::format("the power of h of the {} is not judged: it takes three steps", what));
    return;
  }
  const std::string claim = fmt::format("at least h^{} is predicted", order);
  if (exponent.points < 3) {
    findings.leave_open(
        fmt::format("{} is clear (above rounding, a trend or defect that is measurable, most of the energy "
                    "left) at {} of the steps, "
                    "expected three or more; {}",
                    what, exponent.points, claim));
    return;
  }
  const std::string text = fmt::format("{} falls with h^{:.2f} [{:.2f}, {:.2f}] over {} steps, {}", what,
                                       exponent.value, exponent.low, exponent.high, exponent.points, claim);
  const double least = order - exponent_tolerance;
  if (exponent.low >= least) {
    findings.require(true, text);
  } else if (exponent.high < least && !has_kinks) {
    findings.require(false, text);
  } else {
    findings.leave_open(fmt::format(
        "{}: {}", text, exponent.high < least ? "forces with kinks lower the power" : "not decided"));
  }
}

void judge_conservative(const MethodInfo& info, bool has_kinks, const std::vector<EnergyRun>& runs,
                        const EnergyExponents& exponents, Findings& findings) {
  const bool has_modified = runs.front().seen->modified_change().has_value();
  const bool has_growth = std::isfinite(runs.front().predicted_growth);
  if (has_growth) judge_growth(runs, findings);
  if (has_modified) {
    require_bounded(
        runs, findings, "modified energy",
        [](const EnergyRun& run) { return run.seen->modified_change()->largest_magnitude(); },
        [](const EnergyRun& run) { return rounding_bound(run); });
  }
  if (info.conserves_energy) {
    require_bounded(
        runs, findings, "energy", [](const EnergyRun& run) { return run.seen->change().largest_magnitude(); },
        [&](const EnergyRun& run) {
          return conservation_bound(rounding_bound(run), run.seen->scale(), run.seen->steps_taken(),
                                    info.iteration_tolerance);
        });
  } else if (info.is_symplectic && !has_modified && !has_growth) {
    judge_symplectic(runs, findings);
  } else if (!has_modified && !has_growth) {
    judge_exponent("energy drift", exponents.drift, info.order, has_kinks, runs.size(), findings);
  }
  const EnergyRun& first = runs.front();
  if (first.drift.valid && std::isnan(first.relative_drift())) {
    findings.note(fmt::format(
        "at h = {:.4g} the energy changes by more than a fifth of its size, so that no rate of drift "
        "describes it",
        first.step));
  } else if (first.drift.valid) {
    findings.note(
        fmt::format("at h = {:.4g} the energy drifts by {:.2g} and oscillates by {:.2g} of its size",
                    first.step, first.relative_drift(), first.drift.oscillation / first.seen->scale()));
  }
}

}  // namespace

double EnergyRun::relative_drift() const {
  constexpr double largest = 0.2;
  const double change = drift.slope * drift.duration / seen->scale();
  double last = 0.0;  // mean change at the end: what is gone early leaves no slope
  for (const double mean : seen->change().means()) {
    if (std::isfinite(mean)) last = mean / seen->scale();
  }
  return std::abs(change) < largest && std::abs(last) < largest && !has_blown_up() ? change : no_value;
}

bool EnergyRun::has_blown_up() const {
  return status.code == StatusCode::blow_up || status.code == StatusCode::non_finite ||
         ((is_energy || seen->start() != 0.0) && seen->budget().has_exploded());
}

EnergyRun follow_energy(const WatchedProblem& watched, const Ivp& given, const Integrator& integrator,
                        const EnergyTheory& theory, double step, std::uint64_t steps, std::uint64_t bins,
                        const RunContext& context) {
  EnergyRun run;
  run.step = step;
  run.steps = steps;
  run.is_energy = watched.gauge.is_known();
  Ivp ivp = given;
  ivp.t1 = ivp.t0 + step * static_cast<double>(steps);
  run.seen = std::make_unique<EnergyObserver>(
      watched,
      watched.is_driven ? analysis::EnergyFunction()
                        : analysis::modified_energy(theory.modified_energy, ivp, step, watched.value),
      step, steps, bins);
  const Solution solution = context.solve(integrator, ivp, FixedStep{.step = step}, *run.seen);
  run.status = solution.status;
  run.end_time = solution.time;
  run.drift = analysis::fit_drift(run.seen->change());

  run.growth = run.predicted_growth = run.growth_tolerance = no_value;
  const std::optional<analysis::BinnedSeries>& logarithm = run.seen->logarithm();
  if (logarithm && logarithm->count() > 10) {
    const double taken = static_cast<double>(logarithm->count());
    run.growth = 0.5 * logarithm->slope();
    if (theory.factors) {
      const double z = watched.frequency * step;
      const analysis::NumericalOscillation predicted =
          analysis::numerical_oscillations(theory.factors, {z}).front();
      if (predicted.oscillates) run.predicted_growth = std::log(std::abs(predicted.factor));
      // ln E swings by `swing` about its trend with the frequency 2z: that leaves a slope of 6·swing/(z n²).
      const analysis::Drift trend = analysis::fit_drift(*logarithm);
      const double swing = std::max(0.0, trend.oscillation - 0.5 * std::abs(trend.slope) * taken / 20.0);
      // The first steps of multistep schemes, and the swing of schemes whose matrix is not normal, leave a
      // share of the growth itself.
      constexpr double relative = 1e-5;
      run.growth_tolerance =
          relative * std::abs(run.predicted_growth) + 12.0 * swing / (z * taken * taken) + 10.0 * epsilon;
    }
  }
  return run;
}

StepExponent exponent_in_step(const std::vector<double>& steps, const std::vector<double>& values) {
  StepExponent exponent{no_value, no_value, no_value, static_cast<int>(steps.size())};
  if (steps.size() == 2) {
    exponent.value = std::log(values[0] / values[1]) / std::log(steps[0] / steps[1]);
  } else if (const analysis::PowerLaw law = analysis::fit_power_law(steps, values); law.valid) {
    exponent = {law.exponent, law.exponent_low, law.exponent_high, law.points};
  }
  return exponent;
}

EnergyExponents measure_exponents(const std::vector<EnergyRun>& runs) {
  std::vector<double> drift_steps, drifts, steps, oscillations, balance_steps, balances;
  for (const EnergyRun& run : runs) {
    if (is_clear(run)) {
      drift_steps.push_back(run.step);
      drifts.push_back(std::abs(run.drift.slope));
    }
    if (!run.status.ok()) continue;
    if (run.drift.valid && run.drift.oscillation > rounding_bound(run)) {
      steps.push_back(run.step);
      oscillations.push_back(run.drift.oscillation);
    }
    if (run.seen->balance().empty()) continue;
    const double defect = std::abs(run.seen->balance().back());
    if (defect > 10.0 * rounding_bound(run)) {
      balance_steps.push_back(run.step);
      balances.push_back(defect);
    }
  }
  return {exponent_in_step(drift_steps, drifts), exponent_in_step(steps, oscillations),
          exponent_in_step(balance_steps, balances)};
}

EnergyVerdict judge_energy(const WatchedProblem& watched, const MethodInfo& info, bool keeps_angular_momentum,
                           const std::vector<EnergyRun>& runs, const EnergyExponents& exponents) {
  Findings findings;
  const EnergyRun& first = runs.front();
  const bool has_kinks = watched.springs != nullptr && !watched.springs->is_smooth();
  if (watched.is_driven) {
    judge_exponent("energy minus work from outside and of dampers", exponents.balance,
                   watched.is_damped ? info.order_with_velocity_forces : info.order, has_kinks, runs.size(),
                   findings);
    if (!first.seen->work().empty()) {
      findings.note(
          fmt::format("the energy changes by {:.3g} {} through work; {:.2g} are left open at h = {:.4g}",
                      -first.seen->work().back(), watched.unit, first.seen->balance().back(), first.step));
    }
  } else if (watched.is_damped) {
    judge_exponent("energy loss minus work of the dampers", exponents.balance,
                   info.order_with_velocity_forces, has_kinks, runs.size(), findings);
    if (!first.seen->work().empty()) {
      findings.note(fmt::format(
          "of {:.3g} {} at the start {:.3g} are lost, the dampers' work leaves {:.2g} open at h = {:.4g}",
          first.seen->start(), watched.unit, first.seen->work().back(), first.seen->balance().back(),
          first.step));
    }
  } else {
    judge_conservative(info, has_kinks, runs, exponents, findings);
  }
  // Growth that theory predicts is a statement of its own; any other run that failed leaves the case open.
  const bool is_predicted = std::isfinite(first.predicted_growth);
  for (const EnergyRun& run : runs) {
    if (!run.has_blown_up() && run.status.ok()) continue;
    const std::string text = how_it_failed(run);
    if (is_predicted) {
      findings.note(text);
    } else {
      findings.leave_open(text);
    }
  }
  if (watched.is_free) judge_momenta(info, keeps_angular_momentum, runs, findings);
  return findings.verdict();
}

}  // namespace fw::study
