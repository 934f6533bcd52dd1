#pragma once

#include <cstdint>
#include <limits>

#include "core/state_archive.hpp"
#include "core/status.hpp"
#include "core/work.hpp"
#include "ode/ode_system.hpp"
#include "ode/step_control.hpp"

namespace fw::integrators {

/// A step on its way through the run loop.
struct LoopStep {
  std::uint64_t index = 1;   ///< 1 for the first
  double start = 0.0;        ///< t_n [s]
  double end = 0.0;          ///< t_{n+1}; of a library that chooses its steps known after the attempt
  double limit = std::numeric_limits<double>::infinity();  ///< a step that is chosen does not go beyond it
  bool is_last = false;      ///< ends the run; the loop then sets `end` to the end time
  bool is_accepted = false;  ///< what the attempt came to
};

/// Who proposes the steps of a run and makes them: constant steps, steps chosen by our error estimates, or a
/// foreign library. Everything else of a run is the loop's (`run_loop`).
class StepSource {
 public:
  virtual ~StepSource() = default;

  /// Chooses the step that starts at `step.start`: its end, and whether it is the last. Called again after an
  /// attempt that was rejected. A failure ends the run.
  virtual Status propose(LoopStep& step) = 0;

  /// Tries it from y and writes the result into `y_new`. A rejected attempt (`step.is_accepted` false) has
  /// been counted and is followed by another proposal; a failure ends the run.
  virtual Status attempt(LoopStep& step, ConstVectorRef y, VectorRef y_new) = 0;

  /// What the steps are chosen by; null where they are constant, which no `LoopStep::limit` changes.
  virtual const AdaptiveStep* tolerances() const = 0;
  /// The last attempt, which was accepted, is not taken: what follows starts from (t, y) again, where it did.
  virtual void take_back(double t, ConstVectorRef y) = 0;
  /// The step to come is not to be longer than h [s], for a reason that the past of the run does not tell.
  virtual void shorten(double h) = 0;

  /// The last attempt has become the state.
  virtual void accept(const LoopStep& step) = 0;

  /// Whether `interpolate` is of the scheme; without one the loop interpolates by cubic Hermite polynomials.
  virtual bool has_dense_output() const = 0;
  /// y(t) inside the step accepted last.
  virtual void interpolate(double t, VectorRef out) = 0;

  /// The state is y now, by another's doing: forgets what was known of the old one.
  virtual void restart(double t, ConstVectorRef y) = 0;

  /// Visits what the next step depends on. Throws InputError where that cannot be saved.
  virtual void serialise(StateArchive& archive) = 0;

  /// Adds what only a library has counted, once, at the end.
  virtual void collect_work(Work& work) const = 0;
};

}  // namespace fw::integrators
