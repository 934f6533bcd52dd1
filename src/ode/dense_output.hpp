#pragma once

#include <string>

namespace fw {

/// How a method gives the state inside a step, y(t_n + θh) with 0 < θ < 1 (decision 0070).
enum class DenseOutput {
  /// The cubic polynomial through values and slopes of both ends: order 3 at most.
  cubic_hermite,
  /// A step of the same scheme of length θh from the start of the step: the order of the scheme at every θ.
  side_steps,
  /// The polynomial through values and slopes of both ends and of side steps to nodes between them: the order
  /// of the scheme, at a cost per step that does not grow with the number of states asked for.
  side_step_polynomial,
  /// What a foreign library interpolates from its own history: of the order of its step.
  library,
  /// A run of the foreign library from the start of the step, with the tolerances of the run.
  side_runs,
};

/// As it stands in files and messages, for example "cubic Hermite polynomials".
std::string to_string(DenseOutput dense_output);

}  // namespace fw
