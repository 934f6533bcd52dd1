#pragma once

#include <vector>

#include "ode/event_locator.hpp"
#include "oracles/sundials/cvode.hpp"

namespace fw::oracles {

/// A run of CVODE and the events that CVODE itself has found on it.
struct SolutionWithEvents {
  Solution solution;
  std::vector<Event> events;  ///< in the order of time, at equal times in the order of the functions
};

/// Solves `ivp` by CVODE with its own root finding (modified secant iteration on its dense output, to 100
/// roundings of t + h), the counterpart of `EventLocator` and with its conventions:
///  - `observer` sees the steps of the run as if there were no events; after a terminal event it gets the
///    event as its last view, and time and state of the solution are those of the event, whose status is
///    stopped_by_observer with the event's name;
///  - a zero at the start is no event; a change of sign in the other direction is passed over; an even number
///    of zeros within a step is not seen.
/// Throws InputError where an event function is empty or not finite, and where the tolerances or options are
/// out of range; hands on what the right-hand side or an event function throws.
SolutionWithEvents solve_with_cvode_roots(CvodeFormula formula, const CvodeOptions& options, const Ivp& ivp,
                                          const AdaptiveStep& tolerances,
                                          const std::vector<EventFunction>& functions, Observer& observer);

}  // namespace fw::oracles
