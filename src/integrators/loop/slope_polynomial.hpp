#pragma once

#include <array>

namespace fw::integrators {

/// The polynomial of degree 5 on [0, 1] that has given values at both ends and given slopes at 0, 0.18, 0.82
/// and 1, for the continuation of continuous weights to order 5.
///
/// With l_i Lagrange's polynomials of the places, ω = ∏(θ − θ_i) and W = ∫₀^θ ω it is
///   p(θ) = y₀ + (y₁ − y₀) w(θ) + Σ_i p'(θ_i) (∫₀^θ l_i − w(θ) ∫₀¹ l_i),  w = W(θ)/W(1).
/// The places make its error small, |θ⁶ − p| ≤ 0.0018 (for the Hermite polynomial with a double place at ½ it
/// is 0.0023), and stay clear of those of Lobatto (0.2764), where W(1) = 0.
class SlopePolynomial {
 public:
  /// Of the value at 1 and of the slopes; that of the value at 0 is what is left of 1.
  struct Weights {
    double end = 0.0;
    std::array<double, 4> slopes{};
  };

  static const std::array<double, 4>& places();
  static Weights weights(double theta);
};

}  // namespace fw::integrators
