#pragma once

#include <vector>

#include "schemes/additive_tableau.hpp"
#include "schemes/butcher_tableau.hpp"
#include "schemes/nystrom_tableau.hpp"
#include "schemes/rosenbrock_tableau.hpp"
#include "schemes/splitting_scheme.hpp"

namespace fw::schemes {

/// Orders of accuracy by the order conditions of rooted trees. A condition counts as met where its residual
/// is at most what the uncertainty of the coefficients and the rounding of the arithmetic explain.
inline constexpr int highest_order = 9;                       ///< decided for Runge–Kutta methods
inline constexpr int highest_order_with_velocity_forces = 9;  ///< for Nyström trees
inline constexpr int highest_additive_order = 6;

/// The order of the weights `b` on the stages of a Runge–Kutta method in S = Float128 or Rational (no
/// rounding at all); `allowed` bounds the residual, in units of Σ|b_i Φ_i(τ)| + 1.
template <class S>
int order_of_weights(const TableauValues<S>& tableau, const std::vector<S>& b, double allowed);

/// Orders in q and v apart; a scheme has the order of the lesser.
struct NystromOrder {
  int position = 0;
  int velocity = 0;
  int least() const { return position < velocity ? position : velocity; }
};

/// S = long double or Float128.
template <class S>
NystromOrder order_of_weights(const NystromValues<S>& tableau, const std::vector<S>& b_position,
                              const std::vector<S>& b_velocity, bool velocity_forces, double allowed);

int order_of_accuracy(const ButcherTableau& tableau);
/// Order of b̂; 0 where there is none.
int embedded_order(const ButcherTableau& tableau);

/// For forces f(t, q), or f(t, q, v) where `velocity_forces`; the latter is 0 where the scheme has no a_ij
/// for it.
int order_of_accuracy(const NystromTableau& tableau, bool velocity_forces);
int embedded_order(const NystromTableau& tableau);
int order_of_accuracy(const SplittingScheme& scheme, bool velocity_forces);

/// With the exact Jacobian [Hairer, Wanner 1996, IV.7].
int order_of_accuracy(const RosenbrockTableau& tableau);
int embedded_order(const RosenbrockTableau& tableau);

/// With conditions for every colouring of the trees (explicit and implicit part coupled).
int order_of_accuracy(const AdditiveTableau& tableau);
int embedded_order(const AdditiveTableau& tableau);

/// C(q) ∧ B(q): the largest q with Σ_j a_ij c_j^{k−1} = c_i^k/k for all i and k ≤ q. What is left of the
/// order where a problem is very stiff [Hairer, Wanner 1996, IV.15].
int stage_order(const ButcherTableau& tableau);

/// The largest q with Σ b_i c_i^{k−1} = 1/k for k ≤ q: the degree q − 1 of polynomials that the weights
/// integrate exactly.
int quadrature_order(const TableauValues<Float128>& tableau, double allowed);

/// Principal error A^{(p+1)} = (Σ_τ ((b·Φ(τ) − 1/γ(τ))/σ(τ))²)^{1/2} over the trees of order p + 1
/// [Dormand, Prince 1980].
double principal_error(const ButcherTableau& tableau);

}  // namespace fw::schemes
