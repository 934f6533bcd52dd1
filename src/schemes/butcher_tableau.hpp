#pragma once

#include <string>
#include <vector>

#include "schemes/coefficient.hpp"

namespace fw::schemes {

/// A Runge–Kutta method as data: k_i = f(t + c_i h, y + h Σ_j a_ij k_j), y' = y + h Σ_i b_i k_i with the
/// nodes c_i = Σ_j a_ij [Hairer, Nørsett, Wanner 1993, II.1]. Everything else that is said of it is derived.
struct ButcherTableau {
  std::string name{};
  std::string title{};
  std::vector<CoefficientRow> A{};  ///< one row per stage; what is missing at the end of a row is zero
  CoefficientRow b{};               ///< weights, one per stage
  CoefficientRow b_embedded{};      ///< b̂ of the embedded solution ŷ' = y + h Σ_i b̂_i k_i; empty: none
  /// Dense output y(t + θh) = y + h Σ_i b_i(θ) k_i with b_i(θ) = Σ_k dense[i][k] θ^{k+1}; empty: none.
  std::vector<CoefficientRow> dense{};
  std::string reference{};  ///< literature

  int stages() const { return static_cast<int>(b.size()); }
  bool has_embedded_solution() const { return !b_embedded.empty(); }
};

/// The coefficients in the arithmetic S = double, Float128 or Rational.
template <class S>
struct TableauValues {
  int stages = 0;
  std::vector<S> a{};  ///< stages × stages, row by row
  std::vector<S> b{};
  std::vector<S> b_embedded{};  ///< empty: none
  std::vector<S> c{};
  std::vector<std::vector<S>> dense{};  ///< empty: none
  std::string name{};

  const S& A(int i, int j) const { return a[static_cast<std::size_t>(i * stages + j)]; }
};

/// Throws std::logic_error where shapes do not agree.
template <class S>
TableauValues<S> values(const ButcherTableau& tableau);

/// The largest relative uncertainty of a coefficient (see `Coefficient::uncertainty`), at least that of
/// binary128.
double uncertainty(const ButcherTableau& tableau);

/// Whether every coefficient is an exact rational.
bool is_rational(const ButcherTableau& tableau);

enum class TableauShape {
  explicit_stages,    ///< a_ij = 0 for j ≥ i
  diagonal_implicit,  ///< a_ij = 0 for j > i
  fully_implicit,
};

TableauShape shape(const ButcherTableau& tableau);

/// Throws std::logic_error unless shapes agree and Σb = Σb̂ = 1 within the tableau's uncertainty.
void check_tableau(const ButcherTableau& tableau);

}  // namespace fw::schemes
