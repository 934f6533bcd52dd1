#pragma once

#include <vector>

#include "analysis/reference/reference_solution.hpp"
#include "core/types.hpp"

namespace fw::study {

/// The error of an end state against a reference.
struct StateError {
  double position = 0.0;           ///< √(Σ e²/n) over positions [m]; NaN for a first-order system
  double velocity = 0.0;           ///< the same over velocities [m/s]
  double relative = 0.0;           ///< see `measure_error` [1]
  std::vector<double> components;  ///< y_i − reference_i
};

/// Sizes that errors are related to.
struct StateScale {
  double position =
      1.0;  ///< root mean square of the reference's change in position, at least its rounding level
  double velocity = 1.0;  ///< root mean square of its velocity
  double state = 1.0;     ///< of the whole state, for first-order systems
};

/// The reference's own scale, against the start of the problem.
StateScale measure_scale(const Ivp& ivp, const analysis::ReferenceState& reference);

/// Differences are formed in binary128. The relative error is √(½((e_x/s_x)² + (e_v/s_v)²)) of a second-order
/// system, e/s of a first-order one.
StateError measure_error(const Ivp& ivp, ConstVectorRef state, const analysis::ReferenceState& reference,
                         const StateScale& scale);

}  // namespace fw::study
