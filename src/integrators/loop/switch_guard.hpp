#pragma once

#include <optional>

#include "integrators/loop/step_source.hpp"
#include "integrators/loop/switch_cutter.hpp"
#include "integrators/loop/switch_warnings.hpp"
#include "ode/integrator.hpp"

namespace fw::integrators {

/// What a run does about the kinks and jumps that its system announces: steps that are chosen are cut there,
/// constant ones are watched. Nothing at all where the system announces none.
class SwitchGuard {
 public:
  using Verdict = SwitchCutter<double>::Verdict;

  /// `source` tells whether steps are chosen; `step` is the length of constant ones.
  SwitchGuard(const Ivp& ivp, const StepSource& source, const SolveOptions& options);

  /// The step to come ends here at the latest.
  double limit() const;
  /// On a step that was accepted, from y to y_new.
  Verdict judge(const LoopStep& step, ConstVectorRef y, ConstVectorRef y_new);
  /// The switch that a step has crossed, in words.
  std::string last() const;
  /// Writes what was met.
  void report(Solution& solution) const;
  void serialise(StateArchive& archive);

 private:
  const OdeSystem& system_;
  bool has_surfaces_;
  bool has_started_ = false;
  std::optional<SwitchCutter<double>> cutter_;
  std::optional<SwitchWarnings> warnings_;
};

}  // namespace fw::integrators
