#pragma once

#include "ode/second_order_system.hpp"

namespace fw {

/// The Jacobian of a second-order system M q̈ = f(t, q, v) as a first-order one, y = (q, v), ẏ = (v, M⁻¹f):
///
///   J = [[0, I], [M⁻¹K, M⁻¹D]],   K = ∂f/∂q, D = ∂f/∂v,
///
/// in compressed columns. With the tangent matrices' columns as they are, column c < n of J holds the entry
/// (c, c) and then column c of M⁻¹K, column n + c holds the entry (c, n + c), which is 1, and then column c
/// of M⁻¹D. So J has a full diagonal where the tangents have one, and the slots of its entries follow from
/// those of K and D without a search: this class is the one place that knows them.
class FirstOrderJacobian {
 public:
  /// `tangent`: an n×n matrix with the pattern of K and D (`SecondOrderSystem::tangent_pattern`).
  explicit FirstOrderJacobian(const SparseMatrix& tangent);

  /// 2n×2n zeros.
  SparseMatrix pattern() const;

  /// Slot of (c, c), the zero of the upper left block.
  int diagonal(int c) const { return outer_[static_cast<std::size_t>(c)] + c; }
  /// Slot of (c, n + c), the unit of q̇ = v.
  int unit(int c) const { return half() + diagonal(c); }
  /// Slot in the lower left block of the tangents' entry with slot `k` in column c.
  int stiffness(int k, int c) const { return k + c + 1; }
  /// Slot in the lower right block of the tangents' entry with slot `k` in column c.
  int damping(int k, int c) const { return half() + k + c + 1; }

  /// J from K and D (of the tangents' pattern) and the diagonal of M, n entries. The unit stands in the rows
  /// of fixed degrees of freedom as well.
  void fill(const SparseMatrix& K, const SparseMatrix& D, ConstVectorRef mass, SparseMatrix& J) const;

 private:
  int half() const { return outer_.back() + static_cast<int>(outer_.size()) - 1; }

  std::vector<int> outer_, inner_;  ///< the tangents' columns
};

/// out = J(t, y)·w = (w_v, M⁻¹(K w_q + D w_v)) without assembly; rows of fixed degrees of freedom are zero.
void first_order_product(const SecondOrderSystem& system, double t, ConstVectorRef y, ConstVectorRef w,
                         VectorRef out);

}  // namespace fw
