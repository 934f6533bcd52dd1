#pragma once

#include <string>

#include "schemes/scheme_data.hpp"

namespace fw::analysis {

/// How the global error of a scheme on the Prothero–Robinson equation ẏ = λ(y − φ(t)) + φ'(t), y(0) = φ(0),
/// falls with the step while hλ stays far out on the negative real axis [Hairer, Wanner 1996, IV.15].
struct StiffOrder {
  bool valid = false;        ///< the scheme has coefficients that tell, and the error does not grow
  std::string reason{};      ///< why not valid
  int order = 0;             ///< p with error ~ h^p at constant λ
  int power_of_step = 0;     ///< k of the leading term (hλ)^{−m} h^k φ^{(k)}/k! of the local error
  int power_of_product = 0;  ///< m of that term
  /// |R(∞)| = 1 with R(∞) = 1: local errors add up, and one power of h is lost over an interval.
  bool accumulates = false;
  /// 1/(1 − R(z))·|z|^{-1} for R(z) = 1 − O(1/z): how many steps add up before the damping wins, per unit of
  /// |z|; the order above needs far more than the number of steps.
  double memory = 0.0;

  /// "h^2/lambda".
  std::string formula() const;
};

/// From the coefficients alone, for Runge–Kutta and Rosenbrock schemes (and backward differentiation
/// formulas, where it is h^p/λ). It is not valid where the leading term is not ten times the next one. A step
/// from the exact value has the error Σ_k C_k(z) h^k φ^{(k)}/k! with z = hλ and
///   C_k(z) = bᵀ (I − zB)^{−1} (k α^{k−1} − z α^k − δ_{k1} z γ + 2 δ_{k2} γ) − 1,
/// B = A, α = c, γ = 0 for Runge–Kutta and B = (α_ij + γ_ij) for Rosenbrock schemes. With C_k ~ z^{−m_k}
/// (numerically, in binary128, far out), the leading term is the one that is largest at the step and λ given.
/// Stage order and stiff accuracy are thereby contained: a stage order q gives C_k = 0 for k ≤ q, stiff
/// accuracy m_k ≥ 1.
StiffOrder stiff_order(const schemes::SchemeData& data, double step, double lambda);

}  // namespace fw::analysis
