#pragma once

#include <string>

#include "core/types.hpp"

namespace fw::integrators {

/// A Runge–Kutta method as data: k_i = f(t + c_i h, y + h Σ_j a_ij k_j), y' = y + h Σ_i b_i k_i
/// [Hairer, Nørsett, Wanner 1993, II.1].
struct ButcherTableau {
  std::string name;
  std::string title;
  Matrix A;               ///< stages × stages
  Vector b;               ///< weights
  Vector c;               ///< nodes
  std::string reference;  ///< literature

  int stages() const { return static_cast<int>(b.size()); }
  bool is_explicit() const;  ///< A is strictly lower triangular
};

/// Throws std::logic_error unless the shapes agree, Σb = 1 and c_i = Σ_j a_ij to rounding.
void check_tableau(const ButcherTableau& tableau);

/// The order of accuracy by the rooted-tree order conditions up to order 4; higher orders are reported as 4
/// [Hairer, Nørsett, Wanner 1993, II.2].
int order_of_accuracy(const ButcherTableau& tableau);

}  // namespace fw::integrators
