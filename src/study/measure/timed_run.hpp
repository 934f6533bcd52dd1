#pragma once

#include <vector>

#include "ode/integrator.hpp"
#include "study/plan.hpp"

namespace fw::study {

/// How a run is timed.
struct TimingRule {
  std::int64_t repetitions = 5;   ///< samples after the warm-up
  double shortest_sample = 1e-3;  ///< [s]; a shorter run is repeated within a sample, which is their mean
  double longest_total = 0.25;    ///< [s]; a longer run gets fewer samples, but one at least

  /// `shortest_sample` with --quick [s].
  static constexpr double quick_sample = 1e-4;
};
/// The keys `repetitions`, `shortest_sample` and `longest_timing`.
void declare(settings::Archive& a, TimingRule& rule);

/// Wall-clock seconds of one run.
struct Timing {
  std::vector<double> samples;  ///< `repetitions` entries; NaN for those that were not taken
  double minimum = 0.0;         ///< of the samples: what noise has added least to
};

/// Runs once more and again after a run that took `warm_up_seconds`, and measures. Throws Interrupted.
Timing time_run(const Integrator& integrator, const Ivp& ivp, const StepControl& control,
                double warm_up_seconds, const TimingRule& rule, const RunContext& context);

/// One run that nobody observes. Throws Interrupted.
Solution run_once(const Integrator& integrator, const Ivp& ivp, const StepControl& control,
                  const RunContext& context);

}  // namespace fw::study
