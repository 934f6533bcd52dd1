#include "study/energy/energy_run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace fw::study {

namespace {

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
    return conservation_bound(energy_rounding(scale, steps), scale, steps, info.iteration_tolerance);
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

/// Whether the motion changes in the long run by more than the energy: a trend of the energy's error, which is a
/// function of the state, is then no evidence of a secular one.
bool has_moving_average(const EnergyRun& run) {
  constexpr double share = 0.1, of_the_energy = 3.0;
  const auto has_trend = [](const analysis::Drift& drift) {
    return drift.valid && drift.is_significant(1) && drift.significance() > share;
  };
  const analysis::Drift motion = analysis::fit_drift(run.seen->motion());
  if (has_trend(motion) && std::abs(motion.slope) > of_the_energy * std::abs(run.drift.slope)) return true;
  return run.seen->activity() && has_trend(analysis::fit_drift(*run.seen->activity()));
}

/// Why a trend of the energy in this run would not last; empty where it would.
std::string why_no_secular_trend(const EnergyRun& run, std::size_t runs) {
  if (std::isnan(run.relative_drift()))
    return "it changes by more than a fifth of its size: a shorter step tells";
  if (!run.drift.has_long_batches() || has_moving_average(run)) {
    return "so does the motion, which is slow against the run: more steps tell";
  }
  constexpr std::size_t stricter = 50;  // 0.1 % in place of 5 %
  if (!run.drift.is_significant(stricter * runs))
    return "not beyond what chance may do in many cases: more steps tell";
  return {};
}

/// `why_open`, where it is not empty, tells why a trend cannot refute.
void judge_symplectic(const std::vector<EnergyRun>& runs, const std::string& why_open, Findings& findings) {
  const EnergyRun* worst = nullptr;
  bool holds = true;
  std::string open;
  for (const EnergyRun& run : runs) {
    const analysis::Drift& drift = run.drift;
    if (run.has_blown_up() || !run.status.ok()) continue;
    // Without an oscillation inside the batches there is nothing to hold a trend against.
    const bool has_short_batches =
        !drift.valid || run.seen->steps_taken() < 2 * static_cast<std::uint64_t>(drift.batches);
    if (has_short_batches) continue;
    const bool within_rounding = std::abs(drift.slope) * drift.duration <= run.rounding();
    const bool fine = within_rounding || !drift.is_significant(runs.size()) || drift.significance() <= 0.1;
    const std::string why = fine                ? std::string()
                            : !why_open.empty() ? why_open
                                                : why_no_secular_trend(run, runs.size());
    if (!why.empty()) {
      if (open.empty()) {
        open = fmt::format(
            "no secular drift is not decided: over {} steps at h = {:.4g} the energy moves one way; {}",
            run.seen->steps_taken(), run.step, why);
      }
      continue;
    }
    if (worst == nullptr || !fine || (holds && drift.significance() > worst->drift.significance()))
      worst = &run;
    holds = holds && fine;
    if (!fine) break;
  }
  if (!open.empty() && holds) {
    findings.leave_open(open);
    return;
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
/// Where `why_open` is not empty it tells why the figures cannot refute.
void judge_exponent(const char* what, const StepExponent& exponent, int order, const std::string& why_open,
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
  } else if (exponent.high < least && why_open.empty()) {
    findings.require(false, text);
  } else {
    findings.leave_open(fmt::format("{}: {}", text, exponent.high < least ? why_open : "not decided"));
  }
}

void judge_conservative(const MethodInfo& info, std::string why_open, const std::vector<EnergyRun>& runs,
                        const EnergyExponents& exponents, Findings& findings) {
  const bool has_modified = runs.front().seen->modified_change().has_value();
  const bool has_growth = std::isfinite(runs.front().predicted_growth);
  if (has_growth) judge_growth(runs, findings);
  if (has_modified) {
    require_bounded(
        runs, findings, "modified energy",
        [](const EnergyRun& run) { return run.seen->modified_change()->largest_magnitude(); },
        [](const EnergyRun& run) { return run.rounding(); });
  }
  if (info.conserves_energy) {
    const auto change = [](const EnergyRun& run) { return run.seen->change().largest_magnitude(); };
    const auto bound = [&](const EnergyRun& run) {
      return conservation_bound(run.rounding(), run.seen->scale(), run.seen->steps_taken(),
                                info.iteration_tolerance);
    };
    const bool is_kept = std::all_of(runs.begin(), runs.end(), [&](const EnergyRun& run) {
      return run.has_blown_up() || change(run) <= bound(run);
    });
    if (is_kept || why_open.empty()) {
      require_bounded(runs, findings, "energy", change, bound);
    } else {
      findings.leave_open("energy is not kept: " + why_open);
    }
  } else if (info.is_symplectic && !has_modified && !has_growth) {
    judge_symplectic(runs, why_open, findings);
  } else if (!has_modified && !has_growth) {
    if (why_open.empty() && std::any_of(runs.begin(), runs.end(), [](const EnergyRun& run) {
          return run.has_clear_drift() && has_moving_average(run);
        })) {
      why_open = "the motion has a trend of its own, so that runs of different lengths do not compare";
    }
    judge_exponent("energy drift", exponents.drift, info.order, why_open, runs.size(), findings);
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

EnergyVerdict judge_energy(const WatchedProblem& watched, const MethodInfo& info, bool keeps_angular_momentum,
                           const std::vector<EnergyRun>& runs, const EnergyExponents& exponents) {
  Findings findings;
  const EnergyRun& first = runs.front();
  const bool has_kinks = watched.springs != nullptr && !watched.springs->is_smooth();
  const std::string why_open = has_kinks ? "forces have kinks, which theory does not allow for" : "";
  // A law in h begins where h is small.
  const bool is_coarse = std::any_of(runs.begin(), runs.end(), [](const EnergyRun& run) {
    constexpr double small = 0.2;
    const std::vector<double>& balance = run.seen->balance();
    return run.status.ok() && !balance.empty() && !(std::abs(balance.back()) <= small * run.seen->scale());
  });
  const std::string why_balance_is_open =
      why_open.empty() && is_coarse ? "what is left open is no small part of the energy: shorter steps tell"
                                    : why_open;
  if (watched.is_driven) {
    judge_exponent("energy minus work from outside and of dampers", exponents.balance,
                   watched.is_damped ? info.order_with_velocity_forces : info.order, why_balance_is_open,
                   runs.size(), findings);
    if (!first.seen->work().empty()) {
      findings.note(
          fmt::format("the energy changes by {:.3g} {} through work; {:.2g} are left open at h = {:.4g}",
                      -first.seen->work().back(), watched.unit, first.seen->balance().back(), first.step));
    }
  } else if (watched.is_damped) {
    judge_exponent("energy loss minus work of the dampers", exponents.balance,
                   info.order_with_velocity_forces, why_balance_is_open, runs.size(), findings);
    if (!first.seen->work().empty()) {
      findings.note(fmt::format(
          "of {:.3g} {} at the start {:.3g} are lost, the dampers' work leaves {:.2g} open at h = {:.4g}",
          first.seen->start(), watched.unit, first.seen->work().back(), first.seen->balance().back(),
          first.step));
    }
  } else {
    judge_conservative(info, why_open, runs, exponents, findings);
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
