#pragma once

#include "integrators/loop/step_source.hpp"
#include "ode/integrator.hpp"

namespace fw::integrators {

/// Tells runs that go on without getting anywhere from those that are slow for a reason.
///
/// (1) Twenty steps in a row that end where they began (below the rounding of t).
/// (2) Chosen steps that nothing in the run asks for: three times in a row, after a thousand steps each, the
/// pace would take more than a million further steps to the end, does not grow, and the steps are far shorter
/// than the tolerance wants,
///   max(h ρ(J), ‖f(t_{n+1}, y_{n+1}) − f(t_n, y_n)‖/‖f‖) < 0.01 ε^{1/(q+1)},
/// with ρ by power iteration, q the order of the estimate (1 where it is not known) and ε the smallest relative
/// tolerance of a component. So creeps an error estimate that is nothing but rounding. Steps as long as the
/// largest that the user allows are his.
class ProgressWatch {
 public:
  /// All of it outlives the watch; `tolerances` is null where steps are constant.
  ProgressWatch(const MethodInfo& info, const Ivp& ivp, const AdaptiveStep* tolerances);

  /// Of the step from (step.start, y) to (step.end, y_new), which has been accepted: step_too_small (1),
  /// no_progress (2).
  Status judge(const LoopStep& step, ConstVectorRef y, ConstVectorRef y_new);

  void serialise(StateArchive& archive);

 private:
  Status judge_pace(const LoopStep& step, ConstVectorRef y, ConstVectorRef y_new);
  /// The left side of (2).
  double change_in_step(const LoopStep& step, ConstVectorRef y, ConstVectorRef y_new) const;
  double smallest_relative_tolerance(ConstVectorRef y) const;

  const Ivp& ivp_;
  const AdaptiveStep* tolerances_;
  int estimate_order_;
  std::uint64_t standing_ = 0;        ///< steps in a row that end where they began
  std::uint64_t steps_ = 0;           ///< since the last look
  double window_start_, pace_ = 0.0;  ///< time of the last look; seconds passed in the thousand before it
  int idle_ = 0;                      ///< looks in a row that found (2)
};

}  // namespace fw::integrators
