#pragma once

#include "analysis/reference/reference_solution.hpp"
#include "ode/stop_token.hpp"

namespace fw::analysis {

/// y(t₁) in double arithmetic, for systems that are too large for binary128: the method of Dormand and
/// Prince of order 8 at a relative tolerance of 1e-11 gives the value, Verner's pair of orders 8(7) at 1e-10
/// the error: the largest difference of the two over the positions, and over the velocities (over all
/// components of a first-order system). Both run with no step above 1/64 of the interval. Smooth problems are
/// known to about 1e-9 of their scale this way. Where `stop` ended it the status tells.
ReferenceSolution binary64_reference(const Ivp& ivp, StopToken stop = {});

}  // namespace fw::analysis
