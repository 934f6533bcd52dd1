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

}  // namespace

double energy_rounding(double magnitude, std::uint64_t steps) {
  return epsilon * magnitude * (50.0 + 20.0 * std::sqrt(static_cast<double>(steps)));
}

double EnergyRun::rounding() const {
  return energy_rounding(seen->budget().magnitude(), seen->steps_taken());
}

bool EnergyRun::has_clear_drift() const {
  const double change = std::abs(relative_drift());  // NaN beyond 0.2
  return status.ok() && drift.valid && drift.slope_low * drift.slope_high > 0.0 &&
         change * seen->scale() > 100.0 * rounding();
}

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
    if (run.has_clear_drift()) {
      drift_steps.push_back(run.step);
      drifts.push_back(std::abs(run.drift.slope));
    }
    if (!run.status.ok()) continue;
    if (run.drift.valid && run.drift.oscillation > run.rounding()) {
      steps.push_back(run.step);
      oscillations.push_back(run.drift.oscillation);
    }
    if (run.seen->balance().empty()) continue;
    const double defect = std::abs(run.seen->balance().back());
    if (defect > 10.0 * run.rounding()) {
      balance_steps.push_back(run.step);
      balances.push_back(defect);
    }
  }
  return {exponent_in_step(drift_steps, drifts), exponent_in_step(steps, oscillations),
          exponent_in_step(balance_steps, balances)};
}

}  // namespace fw::study
