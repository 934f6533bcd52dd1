#pragma once

#include <complex>
#include <vector>

#include "schemes/butcher_tableau.hpp"
#include "schemes/rosenbrock_tableau.hpp"

namespace fw::schemes {

/// R(z) = P(z)/Q(z), by which a one-step scheme multiplies the solution of ẏ = λy in a step, z = hλ
/// [Hairer, Wanner 1996, IV.3]. Coefficients by rising powers, Q(0) = 1, without common factors z.
struct StabilityFunction {
  std::vector<Float128> numerator{};    ///< P
  std::vector<Float128> denominator{};  ///< Q

  std::complex<double> operator()(std::complex<double> z) const;
};

/// R(z) = det(I − zA + z e bᵀ)/det(I − zA), with both determinants as polynomials by the Faddeev–LeVerrier
/// recursion in binary128. Coefficients below the uncertainty of the tableau are zero, and common roots of P
/// and Q are removed.
StabilityFunction stability_function(const ButcherTableau& tableau);
StabilityFunction embedded_stability_function(const ButcherTableau& tableau);
/// With A replaced by α + γ.
StabilityFunction stability_function(const RosenbrockTableau& tableau);

/// What R says of the scheme.
struct LinearStability {
  double real_interval = 0.0;       ///< largest r with |R(x)| ≤ 1 on [−r, 0]; infinite if there is none
  double imaginary_interval = 0.0;  ///< largest r with |R(iy)| ≤ 1 on [−r, r]; infinite if there is none
  bool is_a_stable = false;         ///< |R| ≤ 1 in the left half-plane
  bool is_l_stable = false;         ///< A-stable and R(∞) = 0
  double alpha_degrees = 0.0;  ///< largest α with |R| ≤ 1 where |arg(−z)| ≤ α; 90 for A-stable schemes
  double at_infinity = 0.0;    ///< |R(∞)|
  int order = 0;               ///< R(z) = e^z + O(z^{order+1})
  double error_constant = 0.0;  ///< C with e^z − R(z) = C z^{order+1} + …
  int dispersion_order = 0;     ///< arg R(iy) = y + O(y^{order+1})
  /// |R(iy)| = 1 + O(y^{order+1}); −1: |R(iy)| = 1, nothing is dissipated.
  int dissipation_order = 0;
};

LinearStability linear_stability(const StabilityFunction& R);

}  // namespace fw::schemes
