#include "study/measure/step_ladder.hpp"

#include <algorithm>
#include <cmath>

namespace fw::study {

FixedStep constant_steps(const Ivp& ivp, std::int64_t steps) {
  return {.step = (ivp.t1 - ivp.t0) / static_cast<double>(steps), .allow_short_last_step = false};
}

AdaptiveStep chosen_steps(double tolerance, double absolute_over_relative, std::int64_t most_steps) {
  return {.relative_tolerance = tolerance,
          .absolute_tolerance = tolerance * absolute_over_relative,
          .maximum_steps = static_cast<std::uint64_t>(most_steps)};
}

std::int64_t affordable_steps(const MethodInfo& info, std::int64_t evaluations) {
  return evaluations / std::max(info.stages, 1);
}

std::vector<LadderStep> step_ladder(std::int64_t first, double ratio, std::int64_t levels,
                                    std::int64_t most) {
  std::vector<LadderStep> ladder;
  for (std::int64_t k = 0; k < levels; ++k) {
    const double exact = static_cast<double>(first) * std::pow(ratio, static_cast<double>(k));
    const auto steps = static_cast<std::int64_t>(std::llround(exact));
    if (steps > most) break;
    // A ratio near 1 rounds to the same number of steps.
    if (ladder.empty() || ladder.back().steps != steps) ladder.push_back({k, steps});
  }
  return ladder;
}

}  // namespace fw::study
