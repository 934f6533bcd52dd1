#pragma once

#include <cstdint>
#include <optional>
#include <type_traits>
#include <vector>

#include "ode/integrator.hpp"

namespace fw::study {

/// What a search by doubling has found.
template <class Run>
struct DoubledSteps {
  std::optional<Run> run{};   ///< the first accepted run; empty: none was
  std::int64_t steps = 0;     ///< its number of steps
  std::int64_t rejected = 0;  ///< number of steps of the run before it; 0: it was the first one
};

/// Runs with `first`, 2·first, 4·first, … steps, at most `most`, until one is accepted. `try_run(steps)` gives
/// an optional, which is empty where the run is not accepted.
template <class TryRun>
auto double_steps(std::int64_t first, std::int64_t most, TryRun try_run) {
  DoubledSteps<typename std::invoke_result_t<TryRun, std::int64_t>::value_type> found;
  for (found.steps = first; found.steps <= most; found.steps *= 2) {
    found.run = try_run(found.steps);
    if (found.run) break;
    found.rejected = found.steps;
  }
  return found;
}

/// The interval of a problem in so many steps, the last one as long as the others.
FixedStep constant_steps(const Ivp& ivp, std::int64_t steps);

/// Steps of its own choice at a relative tolerance.
AdaptiveStep chosen_steps(double tolerance, double absolute_over_relative, std::int64_t most_steps);

/// How many steps a run of at most `evaluations` right-hand sides can have, one per stage.
std::int64_t affordable_steps(const MethodInfo& info, std::int64_t evaluations);

/// One run of a ladder of constant steps.
struct LadderStep {
  std::int64_t level = 0;  ///< k of the exact number of steps, first·ratioᵏ
  std::int64_t steps = 0;  ///< nearest integer
};

/// The whole numbers of steps nearest to first·ratioᵏ, k = 0 … levels − 1, ascending, none twice and none
/// above `most`. `ratio` is above 1.
std::vector<LadderStep> step_ladder(std::int64_t first, double ratio, std::int64_t levels, std::int64_t most);

}  // namespace fw::study
