#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ode/integrator.hpp"
#include "ode/observer.hpp"

namespace fw {

/// In which direction g has to pass through zero.
enum class EventDirection {
  rising,   ///< from negative to positive
  falling,  ///< from positive to negative
  both,
};

/// An event is where g(t, y(t)) reaches zero. g is continuous along the solution and reads its arguments
/// only.
struct EventFunction {
  std::string name{};  ///< for messages
  std::function<double(double t, ConstVectorRef y)> value{};
  EventDirection direction = EventDirection::both;
  bool terminal = false;  ///< ends the run at the first event
};

/// One event that was found.
struct Event {
  double time = 0.0;         ///< [s]
  Vector state;              ///< the dense output there
  std::size_t function = 0;  ///< index of the event function
};

struct EventOptions {
  double time_tolerance = 1e-10;  ///< [s], > 0: width of the last bracket
  int samples_per_step = 1;       ///< places per step where the signs are looked at, the end being one, >= 1
};

/// Watches event functions along a run, locates their zeros inside the steps and passes every step on to
/// another observer.
///
/// - A change of sign between two samples is located by the ITP method [Oliveira, Takahashi 2020] on the dense
///   output of the step: never slower than bisection by more than two evaluations, superlinear for simple
///   zeros. The time reported is the far end of a bracket not wider than `time_tolerance` (or neighbouring
///   doubles), so that g has its new sign there or is zero, and a run that goes on from there does not meet the
///   event again. Its error is at most the width of the bracket + the error of the dense output / |dg/dt|.
/// - Several events of one step are reported in the order of time, at equal times in the order of the functions.
/// - A zero at the start of the run is no event; neither is leaving it. A zero exactly at a sample is an event
///   when it is reached (so also where g only touches zero there), once.
/// - An even number of zeros between two samples is not seen: double zeros (grazing) and zeros closer to each
///   other than the samples. `samples_per_step` narrows the gap; each sample inside costs an interpolation.
/// - After a terminal event nothing later is reported; the inner observer gets the event as its last view
///   (index of the step, `last` false) and the run is stopped.
class EventLocator final : public Observer {
 public:
  /// Throws InputError where an option is out of range or a function is missing. `inner` outlives the
  /// locator.
  EventLocator(std::vector<EventFunction> functions, Observer& inner, EventOptions options = {});

  /// Throws InputError where the method offers no interpolation inside its steps (nothing is replaced by a
  /// straight line), and where g is not finite.
  bool observe(const StepView& view) override;

  /// In the order of time.
  const std::vector<Event>& events() const { return events_; }
  /// The event that stopped the run, or null.
  const Event* terminal_event() const { return terminated_ ? &events_.back() : nullptr; }
  const std::vector<EventFunction>& functions() const { return functions_; }

 private:
  double value(std::size_t k, double t, ConstVectorRef y) const;
  void start(const StepView& view);
  void search(const StepView& view, double from, double to, ConstVectorRef end_state);
  std::optional<double> crossing(const StepView& view, std::size_t k, double from, double to,
                                 double end_value);

  std::vector<EventFunction> functions_;
  Observer& inner_;
  EventOptions options_;
  std::vector<double> values_;  ///< g at the last sample
  std::vector<Event> events_;
  Vector sample_, trial_;
  double sample_time_ = 0.0;
  bool terminated_ = false;
};

/// `integrator.solve` with `locator` as observer. Where a terminal event stops the run, time and state of the
/// solution are those of the event, and its status is stopped_by_observer with the name of the event.
Solution solve_with_events(const Integrator& integrator, const Ivp& ivp, const StepControl& control,
                           EventLocator& locator, const SolveOptions& options = {});

}  // namespace fw
