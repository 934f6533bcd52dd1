#pragma once

#include <functional>
#include <string_view>

#include "core/types.hpp"
#include "ode/stop_token.hpp"

namespace fw {

class StateArchive;

/// What a hook has changed at an accepted step.
enum class Change {
  none,
  state,    ///< y: the stepper starts anew from it
  pattern,  ///< also which entries Jacobians and tangent matrices have: matrices are analysed anew
};

/// May change a run at its accepted steps: a projection on constraints, an impulse at a contact, elements
/// that come and go.
class StepHook {
 public:
  virtual ~StepHook() = default;

  /// Called after every accepted step, with time and state at its end, before the observer sees them: what is
  /// observed, stored and returned is the changed state, from which the run goes on. Inside the step dense
  /// output stays that of the step as the method made it. A change that is not told (`none`) leaves what a
  /// method remembers of the old state, such as slopes and factors, in use.
  virtual Change on_accepted(double t, VectorRef y) = 0;
};

/// Keeps a run on its way, so that it can be continued.
class CheckpointSink {
 public:
  virtual ~CheckpointSink() = default;

  /// Asked after every accepted step but the last, after hook and observer.
  virtual bool is_due(double t) = 0;
  /// Takes the state of the run after the step that ended at `t`, as `SolveOptions::resume` reads it; valid
  /// during the call only.
  virtual void take(double t, std::string_view saved) = 0;
};

/// What goes with a run beside problem, step control and observer. All of it outlives the run.
struct SolveOptions {
  StopToken stop{};                       ///< looked at before every attempt of a step
  StepHook* hook = nullptr;               ///< null: none
  CheckpointSink* checkpoints = nullptr;  ///< null: none. InputError for methods that cannot be saved
  /// The state saved by a checkpoint of the same method, problem and step control: the run goes on from it,
  /// and the observer sees the steps after it only. Empty: the run begins at its start. InputError where it
  /// is of another run.
  std::string_view resume{};
  /// Steps that the method chooses end at the kinks and jumps that the system announces. Only for showing
  /// what happens otherwise.
  bool cut_at_switches = true;
};

}  // namespace fw
