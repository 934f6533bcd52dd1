#pragma once

#include <cstdint>
#include <vector>

namespace fw::schemes {

/// A rooted tree τ = [τ_1, …, τ_m]: one order condition of a Runge–Kutta method [Hairer, Nørsett, Wanner
/// 1993, II.2].
struct RootedTree {
  int order = 1;                ///< ρ(τ), number of vertices
  std::vector<int> children{};  ///< places of τ_1 … τ_m in the list, not decreasing
  double density = 1.0;         ///< γ(τ) = ρ(τ) Π γ(τ_i), exact as long as it is below 2⁵³
  double symmetry = 1.0;        ///< σ(τ) = Π σ(τ_i) · Π multiplicity!
};

/// All rooted trees up to an order ≤ 12, orders ascending: 1, 1, 2, 4, 9, 20, 48, 115, 286, 719, … of each.
const std::vector<RootedTree>& rooted_trees(int highest_order);

/// A rooted tree of a second-order system q̈ = g(q, q̇), root g. A child of the root is one of
///  - v itself (a derivative by q in the direction of the velocity): adds 1 to the order,
///  - a tree through q (the derivative by q meets h² k): adds 1 + its order,
///  - a tree through v (the derivative by q̇ meets h k): adds its order
/// [Hairer, Nørsett, Wanner 1993, II.14].
struct NystromTree {
  int order = 1;
  int velocity_leaves = 0;              ///< children of the first kind
  std::vector<int> through_position{};  ///< places of the children of the second kind, not decreasing
  std::vector<int> through_velocity{};  ///< and of the third
  double exact =
      1.0;  ///< coefficient of h^order in the exact v; that of h^{order+1} in q is exact/(order + 1)
};

/// All such trees up to an order, ascending; without the third kind where forces depend on position only.
const std::vector<NystromTree>& nystrom_trees(int highest_order, bool velocity_forces);

/// A rooted tree whose vertices have one of two colours, for additive methods.
struct ColouredTree {
  int order = 1;
  int colour = 0;  ///< of the root
  std::vector<int> children{};
  double density = 1.0;
};

const std::vector<ColouredTree>& coloured_trees(int highest_order);

}  // namespace fw::schemes
