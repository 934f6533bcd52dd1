#include "study/measure/timed_run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace fw::study {

void declare(settings::Archive& a, TimingRule& rule) {
  using settings::setting;
  a(setting("repetitions", rule.repetitions).integers(1, 1000).quick_fixed(1).doc("of each timing"));
  a(setting("shortest_sample", rule.shortest_sample)
        .unit("s")
        .positive()
        .doc("a shorter run is repeated within a sample; 1e-4 with `--quick`"));
  a(setting("longest_timing", rule.longest_total)
        .unit("s")
        .positive()
        .doc("a longer run gets fewer samples, but one at least"));
}

Solution run_once(const Integrator& integrator, const Ivp& ivp, const StepControl& control,
                  const RunContext& context) {
  NullObserver observer;
  return context.solve(integrator, ivp, control, observer);
}

Timing time_run(const Integrator& integrator, const Ivp& ivp, const StepControl& control,
                double warm_up_seconds, const TimingRule& rule, const RunContext& context) {
  using Clock = std::chrono::steady_clock;
  // The clock may say 0 for the shortest runs.
  const double estimate = std::max(warm_up_seconds, 1e-7);
  const auto runs_per_sample = static_cast<int>(std::max(1.0, std::ceil(rule.shortest_sample / estimate)));
  const auto affordable = static_cast<std::int64_t>(rule.longest_total / (estimate * runs_per_sample));
  const std::int64_t samples = std::clamp<std::int64_t>(affordable, 1, rule.repetitions);
  Timing timing;
  timing.samples.assign(static_cast<std::size_t>(rule.repetitions), std::numeric_limits<double>::quiet_NaN());
  timing.minimum = std::numeric_limits<double>::infinity();
  for (std::int64_t k = 0; k < samples; ++k) {
    const Clock::time_point start = Clock::now();
    for (int run = 0; run < runs_per_sample; ++run) run_once(integrator, ivp, control, context);
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count() / runs_per_sample;
    timing.samples[static_cast<std::size_t>(k)] = seconds;
    timing.minimum = std::min(timing.minimum, seconds);
  }
  return timing;
}

}  // namespace fw::study
