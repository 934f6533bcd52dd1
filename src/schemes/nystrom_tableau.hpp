#pragma once

#include <string>
#include <vector>

#include "schemes/butcher_tableau.hpp"

namespace fw::schemes {

/// A Runge–Kutta–Nyström method for q̈ = g(t, q, q̇) [Hairer, Nørsett, Wanner 1993, II.14]:
///   k_i = g(t + c_i h, q + c_i h v + h² Σ_j ā_ij k_j, v + h Σ_j a_ij k_j),
///   q' = q + h v + h² Σ_i b̄_i k_i,   v' = v + h Σ_i b_i k_i.
struct NystromTableau {
  std::string name{};
  std::string title{};
  CoefficientRow c{};
  std::vector<CoefficientRow> A_position{};  ///< ā, one row per stage; missing entries are zero
  /// a, one row per stage; empty where the method is for g(t, q) only.
  std::vector<CoefficientRow> A_velocity{};
  CoefficientRow b_position{};                                  ///< b̄
  CoefficientRow b_velocity{};                                  ///< b
  CoefficientRow b_position_embedded{}, b_velocity_embedded{};  ///< empty: none
  std::string reference{};

  int stages() const { return static_cast<int>(c.size()); }
  bool has_embedded_solution() const { return !b_velocity_embedded.empty(); }
};

/// The coefficients in the arithmetic S = double, Float128 or Rational.
template <class S>
struct NystromValues {
  int stages = 0;
  std::vector<S> c{};
  std::vector<S> a_position{}, a_velocity{};  ///< stages × stages, row by row; a_velocity may be empty
  std::vector<S> b_position{}, b_velocity{};
  std::vector<S> b_position_embedded{}, b_velocity_embedded{};  ///< empty: none
};

/// Throws std::logic_error where shapes do not agree.
template <class S>
NystromValues<S> values(const NystromTableau& tableau);

/// See `uncertainty(const ButcherTableau&)`.
double uncertainty(const NystromTableau& tableau);

/// A Runge–Kutta method applied to (q, v)' = (v, g): ā = A², b̄ = Aᵀb, so that one set of conditions serves
/// both.
template <class S>
NystromValues<S> as_nystrom(const TableauValues<S>& tableau);

}  // namespace fw::schemes
