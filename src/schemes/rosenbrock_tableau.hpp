#pragma once

#include <string>
#include <vector>

#include "schemes/coefficient.hpp"

namespace fw::schemes {

/// A Rosenbrock method [Hairer, Wanner 1996, IV.7]:
///   k_i = h f(t + α_i h, y + Σ_{j<i} α_ij k_j) + h J Σ_{j≤i} γ_ij k_j + γ_i h² ∂f/∂t,   y' = y + Σ_i b_i k_i
/// with γ_ii = γ, α_i = Σ_j α_ij, γ_i = Σ_j γ_ij and J = ∂f/∂y at (t, y).
struct RosenbrockTableau {
  std::string name{};
  std::string title{};
  std::vector<CoefficientRow> alpha{};  ///< strictly lower triangular; missing entries are zero
  std::vector<CoefficientRow> gamma{};  ///< lower triangular with the constant diagonal γ
  CoefficientRow b{};
  CoefficientRow b_embedded{};  ///< empty: none
  std::string reference{};

  int stages() const { return static_cast<int>(b.size()); }
  bool has_embedded_solution() const { return !b_embedded.empty(); }
};

}  // namespace fw::schemes
