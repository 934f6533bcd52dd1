#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "ode/integrator.hpp"

namespace fw::analysis {

/// How far a solution is refined, and what that may cost.
struct RefinementGoal {
  double error = 1e-8;                   ///< the estimate that ends the refinement, in the norm given
  std::uint64_t fewest_steps = 16;       ///< of the first run with constant steps
  std::uint64_t most_steps = 8192;       ///< of one run; adaptive methods may take 16 times as many
  double first_tolerance = 1e-6;         ///< relative tolerance of an adaptive method's first run
  double smallest_tolerance = 1e-12;     ///< of its last
  double absolute_over_relative = 1e-2;  ///< absolute tolerance in units of the relative one
  StopToken stop{};                      ///< can end a run, and the refinement with it
};

/// A solution with an estimate of its own error, which no other solver had a part in.
struct ConvergedRun {
  Vector state;  ///< of the finest run that succeeded; empty if there is none
  double error_estimate =
      0.0;                 ///< in the norm given; infinite where fewer than three runs in a row succeeded
  double step = 0.0;       ///< of the finest run [s]; 0 where the method chooses its steps
  double tolerance = 0.0;  ///< relative, of the finest run; 0 with constant steps
  std::string warning{};   ///< of the last run, which then does not count: see `Solution::warnings`
  Status status;           ///< of the last run: why there is none, or none finer
  Work work;               ///< of the run that `state` comes from
};

/// Refines until the estimate reaches the goal or the budget is spent: constant steps are halved; tolerances
/// are divided by ten and the largest step allowed is halved, since a method's error estimate can be blind
/// for a problem. With d_k the difference of the two finest runs and ρ = d_{k−1}/d_k, the estimate is the
/// largest of d_k, d_k/(ρ − 1) (which bounds the rest of a geometric series that falls slowly, as under order
/// reduction) and a fraction of d_{k−1} that no method of its order falls below, so that two runs which are
/// close by accident do not count as accurate. It takes three runs; one whose tighter tolerance has not led
/// to more steps does not count as a run, nor does one with warnings.
///
/// `norm` gives the size of a difference of states. `prefers_constant_steps` decides for methods that can do
/// both. Throws InputError where the method cannot run on the problem.
ConvergedRun run_to_accuracy(const Integrator& integrator, const Ivp& ivp,
                             const std::function<double(ConstVectorRef difference)>& norm,
                             const RefinementGoal& goal, bool prefers_constant_steps = false);

}  // namespace fw::analysis
