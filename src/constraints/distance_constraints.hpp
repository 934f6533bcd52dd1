#pragma once

#include <utility>
#include <vector>

#include "core/types.hpp"
#include "core/vec3.hpp"
#include "ode/second_order_system.hpp"

namespace fw::constraints {

/// A rod without mass: particles i and j keep their distance L > 0 [m].
struct DistanceConstraint {
  int first = 0;        ///< i
  int second = 0;       ///< j
  double length = 1.0;  ///< L [m]
};

/// Distance constraints g(q) = 0 on the particles of a second-order system with three degrees of freedom per
/// particle [Zachmann 2011, S19–S20]:
///   g_c(q) = (‖x_j − x_i‖² − L²)/(2L)  [m],
/// which near its zero is the excess ‖x_j − x_i‖ − L and has no square root. With d = x_j − x_i the row of
/// G = ∂g/∂q is (−d/L, d/L) in the columns of i and j, linear in q; the second derivative is constant. The
/// forces of constraint are Gᵀλ: λ_c [N] is the force along the rod, < 0 for tension.
///
/// Columns of fixed degrees of freedom are zero in G: they take any force and do not move. Along a motion
/// ġ = G(q) v and g̈ = G(q) v̇ + G(v) v.
class DistanceConstraints {
 public:
  /// InputError that names the entry where an index is out of range, both ends are the same or fixed, a
  /// length is not positive and finite, or the degrees of freedom are not three per particle.
  DistanceConstraints(const SecondOrderSystem& system, std::vector<DistanceConstraint> constraints);

  const std::vector<DistanceConstraint>& list() const { return list_; }
  /// m, the number of constraints.
  Index size() const { return static_cast<Index>(list_.size()); }
  /// n.
  Index degrees_of_freedom() const { return static_cast<Index>(is_free_.size()); }

  /// g(q), m entries [m].
  void value(ConstVectorRef q, VectorRef g) const;

  /// G(q) w, m entries. With w = v it is ġ [m/s]; with w = v̇ plus G(v) v it is g̈.
  void product(ConstVectorRef q, ConstVectorRef w, VectorRef out) const;

  /// out += G(q)ᵀ λ, n entries [N].
  void add_transposed_product(ConstVectorRef q, ConstVectorRef lambda, VectorRef out) const;

  /// Calls `entry(constraint, degree of freedom, G(q)_cd)` for every entry that is not zero by structure, in
  /// an order that does not depend on q.
  template <class Entry>
  void for_each_derivative(ConstVectorRef q, Entry entry) const {
    for (std::size_t c = 0; c < list_.size(); ++c) {
      for (int axis = 0; axis < 3; ++axis) {
        const Index i = 3 * list_[c].first + axis, j = 3 * list_[c].second + axis;
        const double slope = (q[j] - q[i]) / list_[c].length;
        if (is_free_[static_cast<std::size_t>(i)]) entry(static_cast<Index>(c), i, -slope);
        if (is_free_[static_cast<std::size_t>(j)]) entry(static_cast<Index>(c), j, slope);
      }
    }
  }

  /// Calls `entry(row, column, H_rc)` for the entries of H = ∂(G(q)ᵀλ)/∂q, places may repeat, in an order
  /// that depends on nothing. Rows and columns of fixed degrees of freedom are left out.
  template <class Entry>
  void for_each_second_derivative(ConstVectorRef lambda, Entry entry) const {
    for (std::size_t c = 0; c < list_.size(); ++c) {
      const double h = lambda[static_cast<Index>(c)] / list_[c].length;
      for (int axis = 0; axis < 3; ++axis) {
        const Index i = 3 * list_[c].first + axis, j = 3 * list_[c].second + axis;
        const bool i_is_free = is_free_[static_cast<std::size_t>(i)];
        const bool j_is_free = is_free_[static_cast<std::size_t>(j)];
        if (i_is_free) entry(i, i, h);
        if (j_is_free) entry(j, j, h);
        if (i_is_free && j_is_free) {
          entry(i, j, -h);
          entry(j, i, -h);
        }
      }
    }
  }

 private:
  std::vector<DistanceConstraint> list_;
  std::vector<char> is_free_;  ///< n flags
};

}  // namespace fw::constraints
