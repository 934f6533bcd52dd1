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

/// √(Σ x²/n); 0 of no values.
double root_mean_square(ConstVectorRef values);

/// The scale that gives an error in any component its largest relative value: the smaller one of position and
/// velocity of a second-order system, that of the state otherwise.
double smallest_scale(const Ivp& ivp, const StateScale& scale);

/// The relative size of a difference of two states: √(½((d_x/s_x)² + (d_v/s_v)²)) of a second-order system,
/// d/s of a first-order one, d being root mean squares.
double relative_norm(const Ivp& ivp, ConstVectorRef difference, const StateScale& scale);

/// The reference's own scale, against the start of the problem.
StateScale measure_scale(const Ivp& ivp, const analysis::ReferenceState& reference);

/// Differences are formed in binary128. The relative error is their `relative_norm`.
StateError measure_error(const Ivp& ivp, ConstVectorRef state, const analysis::ReferenceState& reference,
                         const StateScale& scale);

}  // namespace fw::study
