#include "study/energy/energy_run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/fit/power_law.hpp"

namespace fw::study {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Statements that hold or fail, each with its figures.
class Findings {
 public:
  void require(bool holds, std::string text) {
    applies_ = true;
    if (!holds) failed_ = true;
    texts_.push_back(holds ? std::move(text) : "FAILS: " + text);
  }
  void note(const std::string& text) { texts_.push_back(text); }

  EnergyVerdict verdict() const {
    return {failed_    ? Verdict::fails
            : applies_ ? Verdict::holds
                       : Verdict::not_applicable,
            fmt::format("{}", fmt::join(texts_, "; "))};
  }

 private:
  bool applies_ = false, failed_ = false;
  std::vector<std::string> texts_;
};

/// What rounding may do to a quantity of size `scale` in n steps: a walk of a few units per step.
double rounding_bound(double scale, std::uint64_t steps) {
  return epsilon * scale * (50.0 + 20.0 * std::sqrt(static_cast<double>(steps)));
}

/// The same where every step also leaves the equations of a step unsolved by `tolerance`.
double conservation_bound(double scale, std::uint64_t steps, double tolerance) {
  return rounding_bound(scale, steps) + tolerance * scale * static_cast<double>(steps);
}

bool has_ended_well(const std::vector<EnergyRun>& runs) {
  return std::all_of(runs.begin(), runs.end(), [](const EnergyRun& run) { return run.status.ok(); });
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
    findings.note(what + " is not judged: every run blows up");
    return;
  }
  findings.require(
      value(*worst) <= bound(*worst),
      fmt::format("{} changes by at most {:.1e} in {} steps (h = {:.4g}), rounding allows {:.1e}", what,
                  value(*worst), worst->seen->steps_taken(), worst->step, bound(*worst)));
}

void judge_momenta(const MethodInfo& info, bool keeps_angular_momentum, const std::vector<EnergyRun>& runs,
                   Findings& findings) {
  require_bounded(
      runs, findings, "linear momentum",
      [](const EnergyRun& run) { return run.seen->momentum_change()->largest_magnitude(); },
      [&](const EnergyRun& run) {
        return conservation_bound(run.seen->momentum_scale(), run.seen->steps_taken(),
                                  info.iteration_tolerance);
      });
  const auto angular = [](const EnergyRun& run) { return run.seen->angular_change()->largest_magnitude(); };
  if (keeps_angular_momentum) {
    require_bounded(runs, findings, "angular momentum", angular, [&](const EnergyRun& run) {
      return conservation_bound(run.seen->angular_scale(), run.seen->steps_taken(), info.iteration_tolerance);
    });
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
         change > 100.0 * rounding_bound(1.0, run.steps);
}

void judge_symplectic(const std::vector<EnergyRun>& runs, Findings& findings) {
  const EnergyRun* worst = nullptr;
  bool holds = true;
  for (const EnergyRun& run : runs) {
    const analysis::Drift& drift = run.drift;
    if (run.has_blown_up()) continue;
    // Without an oscillation inside the batches there is nothing to hold a trend against.
    const bool has_short_batches =
        !drift.valid || run.seen->steps_taken() < 2 * static_cast<std::uint64_t>(drift.batches);
    if (run.status.ok() && has_short_batches) continue;
    const bool within_rounding =
        std::abs(drift.slope) * drift.duration <= rounding_bound(run.seen->scale(), run.steps);
    const bool fine = run.status.ok() && drift.valid &&
                      (within_rounding || !drift.is_significant(runs.size()) || drift.significance() <= 0.1);
    if (worst == nullptr || !fine || (holds && drift.significance() > worst->drift.significance()))
      worst = &run;
    holds = holds && fine;
    if (!fine) break;
  }
  if (worst == nullptr) {
    findings.note("no secular drift is not judged: every run blows up or has too few steps per batch");
    return;
  }
  findings.require(
      holds, worst->status.ok()
                 ? fmt::format("no secular drift: {:.2g} of the oscillation over {} steps at h = {:.4g}",
                               worst->drift.significance(), worst->steps, worst->step)
                 : fmt::format("the run at h = {:.4g} ended with {}", worst->step, worst->status.describe()));
}

/// Statements about powers of h allow this much below the power.
constexpr double exponent_tolerance = 0.3;

void judge_exponent(const char* what, const StepExponent& exponent, int order, Findings& findings) {
  if (exponent.points < 2) return;
  const std::string interval =
      exponent.points > 2 ? fmt::format(" [{:.2f}, {:.2f}]", exponent.low, exponent.high) : "";
  findings.require(exponent.value >= order - exponent_tolerance,
                   fmt::format("{} falls with h^{:.2f}{} over {} steps, at least h^{} is predicted", what,
                               exponent.value, interval, exponent.points, order));
}

void judge_conservative(const MethodInfo& info, const std::vector<EnergyRun>& runs,
                        const EnergyExponents& exponents, Findings& findings) {
  const bool has_modified = runs.front().seen->modified_change().has_value();
  const bool has_growth = std::isfinite(runs.front().predicted_growth);
  if (has_growth) judge_growth(runs, findings);
  if (has_modified) {
    require_bounded(
        runs, findings, "modified energy",
        [](const EnergyRun& run) { return run.seen->modified_change()->largest_magnitude(); },
        [](const EnergyRun& run) { return rounding_bound(run.seen->scale(), run.seen->steps_taken()); });
  }
  if (info.conserves_energy) {
    require_bounded(
        runs, findings, "energy", [](const EnergyRun& run) { return run.seen->change().largest_magnitude(); },
        [&](const EnergyRun& run) {
          return conservation_bound(run.seen->scale(), run.seen->steps_taken(), info.iteration_tolerance);
        });
  } else if (info.is_symplectic && !has_modified && !has_growth) {
    judge_symplectic(runs, findings);
  } else if (!has_modified && !has_growth) {
    judge_exponent("energy drift", exponents.drift, info.order, findings);
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
  const double change = drift.slope * drift.duration / seen->scale();
  constexpr double largest = 0.2;
  return std::abs(change) < largest && !has_blown_up() ? change : none;
}

bool EnergyRun::has_blown_up() const {
  constexpr double far = 100.0;
  return status.code == StatusCode::blow_up || status.code == StatusCode::non_finite ||
         (seen->start() != 0.0 && !(seen->scale() <= far * std::abs(seen->start())));
}

EnergyRun follow_energy(const WatchedProblem& watched, const Ivp& given, const Integrator& integrator,
                        const EnergyTheory& theory, double step, std::uint64_t steps, std::uint64_t bins,
                        const RunContext& context) {
  EnergyRun run;
  run.step = step;
  run.steps = steps;
  Ivp ivp = given;
  ivp.t1 = ivp.t0 + step * static_cast<double>(steps);
  run.seen = std::make_unique<EnergyObserver>(
      watched, analysis::modified_energy(theory.modified_energy, ivp, step, watched.value), step, steps,
      bins);
  const Solution solution = context.solve(integrator, ivp, FixedStep{.step = step}, *run.seen);
  run.status = solution.status;
  run.end_time = solution.time;
  run.drift = analysis::fit_drift(run.seen->change());

  run.growth = run.predicted_growth = run.growth_tolerance = none;
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
  StepExponent exponent{none, none, none, static_cast<int>(steps.size())};
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
    if (run.drift.valid && run.drift.oscillation > rounding_bound(run.seen->scale(), run.steps)) {
      steps.push_back(run.step);
      oscillations.push_back(run.drift.oscillation);
    }
    if (run.seen->balance().empty()) continue;
    const double defect = std::abs(run.seen->balance().back());
    if (defect > 10.0 * rounding_bound(run.seen->scale(), run.steps)) {
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
  if (watched.is_damped) {
    judge_exponent("energy loss minus work of the dampers", exponents.balance,
                   info.order_with_velocity_forces, findings);
    if (!first.seen->work().empty()) {
      findings.note(fmt::format(
          "of {:.3g} {} at the start {:.3g} are lost, the dampers' work leaves {:.2g} open at h = {:.4g}",
          first.seen->start(), watched.unit, first.seen->work().back(), first.seen->balance().back(),
          first.step));
    }
  } else {
    judge_conservative(info, runs, exponents, findings);
  }
  for (const EnergyRun& run : runs) {
    if (!run.has_blown_up() || !run.status.ok()) continue;
    findings.note(
        fmt::format("h = {:.4g} is left out where bounds are in proportion to the energy, which "
                    "grows to {:.2g} of its start",
                    run.step, run.seen->scale() / std::abs(run.seen->start())));
    break;
  }
  if (watched.is_free) judge_momenta(info, keeps_angular_momentum, runs, findings);
  if (!has_ended_well(runs)) {
    for (const EnergyRun& run : runs) {
      if (run.status.ok()) continue;
      findings.note(
          fmt::format("h = {:.4g} ended at t = {:.4g}: {}", run.step, run.end_time, run.status.describe()));
      break;
    }
  }
  return findings.verdict();
}

}  // namespace fw::study
