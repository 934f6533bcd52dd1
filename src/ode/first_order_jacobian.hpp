#pragma once

#include "ode/second_order_system.hpp"

namespace fw {

/// Where in its value array the Jacobian of a second-order system has its entries, worked out from the slots
/// of K and D without a search and without memory: see `FirstOrderJacobian`.
///
/// Column c < n of J holds the entry (c, c) and then column c of M⁻¹K; column n + c holds the entry
/// (c, n + c), which is 1, and then column c of M⁻¹D. So J has a full diagonal where the tangents have one.
class FirstOrderSlots {
 public:
  FirstOrderSlots() = default;
  /// Of tangents of n degrees of freedom with `tangent_entries` entries each, n ≥ 0.
  FirstOrderSlots(int degrees_of_freedom, int tangent_entries)
      : half_(degrees_of_freedom + tangent_entries) {}

  /// How many entries J has.
  Index entries() const { return 2 * Index{half_}; }
  /// Slot of (c, c), the zero of the upper left block; column c of the tangents begins at slot `begin`.
  int diagonal(int begin, int c) const { return begin + c; }
  /// Slot of (c, n + c), the unit of q̇ = v; column c of the tangents begins at slot `begin`.
  int unit(int begin, int c) const { return half_ + begin + c; }
  /// Slot in the lower left block of the tangents' entry with slot `k` in column c.
  int stiffness(int k, int c) const { return k + c + 1; }
  /// Slot in the lower right block of the tangents' entry with slot `k` in column c.
  int damping(int k, int c) const { return half_ + k + c + 1; }

 private:
  int half_ = 0;  ///< entries in the left half of J
};

/// The Jacobian of a second-order system M q̈ = f(t, q, v) as a first-order one, y = (q, v), ẏ = (v, M⁻¹f):
///
///   J = [[0, I], [M⁻¹K, M⁻¹D]],   K = ∂f/∂q, D = ∂f/∂v,
///
/// in compressed columns, with the tangent matrices' columns as they are (`FirstOrderSlots`).
class FirstOrderJacobian {
 public:
  /// `tangent`: an n×n matrix with the pattern of K and D (`SecondOrderSystem::tangent_pattern`).
  explicit FirstOrderJacobian(const SparseMatrix& tangent);

  /// 2n×2n zeros.
  SparseMatrix pattern() const;

  /// Slot of (c, c), the zero of the upper left block.
  int diagonal(int c) const { return slots_.diagonal(outer_[static_cast<std::size_t>(c)], c); }
  /// Slot of (c, n + c), the unit of q̇ = v.
  int unit(int c) const { return slots_.unit(outer_[static_cast<std::size_t>(c)], c); }
  /// Slot in the lower left block of the tangents' entry with slot `k` in column c.
  int stiffness(int k, int c) const { return slots_.stiffness(k, c); }
  /// Slot in the lower right block of the tangents' entry with slot `k` in column c.
  int damping(int k, int c) const { return slots_.damping(k, c); }

  /// J from K and D (of the tangents' pattern) and the diagonal of M, n entries. The unit stands in the rows
  /// of fixed degrees of freedom as well.
  void fill(const SparseMatrix& K, const SparseMatrix& D, ConstVectorRef mass, SparseMatrix& J) const;

 private:
  FirstOrderSlots slots_;
  std::vector<int> outer_, inner_;  ///< the tangents' columns
};

/// out = J(t, y)·w = (w_v, M⁻¹(K w_q + D w_v)) without assembly; rows of fixed degrees of freedom are zero.
void first_order_product(const SecondOrderSystem& system, double t, ConstVectorRef y, ConstVectorRef w,
                         VectorRef out);

}  // namespace fw
