#pragma once

#include "integrators/structural/alpha_family.hpp"
#include "schemes/scheme_data.hpp"

namespace fw::analysis {

/// What a scheme does on linear systems where no coefficients say so.
enum class LinearRule {
  of_coefficients,
  exact,  ///< the solution itself
  /// Verlet with v_n = (x_{n+1} − x_{n−1})/2h: (1 + hC/2) x_{n+1} = (2 − h²W) x_n − (1 − hC/2) x_{n−1}.
  verlet_central_velocity,
  /// Verlet with v_n = (x_n − x_{n−1})/h: x_{n+1} = (2 − h²W − hC) x_n − (1 − hC) x_{n−1}.
  verlet_backward_velocity,
  alpha_family,  ///< Newmark's scheme and its relatives, by `LinearScheme::alpha`
};

/// A scheme as linear systems see it.
struct LinearScheme {
  schemes::SchemeData data{};  ///< of the scheme that it is on them; std::monostate: see `rule`
  LinearRule rule = LinearRule::of_coefficients;
  integrators::AlphaParameters alpha{};  ///< of the rule `alpha_family`

  /// Whether anything but the scheme's own steps tells what it does.
  bool is_known() const {
    return rule != LinearRule::of_coefficients || !std::holds_alternative<std::monostate>(data);
  }
};

}  // namespace fw::analysis
