#pragma once

#include <vector>

#include "core/work.hpp"
#include "ode/ode_system.hpp"
#include "ode/pattern_watch.hpp"

namespace fw::oracles {

/// Block Jacobi for I − γJ, the matrix of Newton's iteration in implicit methods.
///
/// Of a second-order system M q̈ = f(t, q, v) it keeps what couples a particle (3 degrees of freedom; 1 where
/// their number is no multiple of 3) with itself: with its 3×3 blocks Kᵢᵢ = ∂fᵢ/∂qᵢ, Dᵢᵢ = ∂fᵢ/∂vᵢ the 6×6
/// block of I − γJ is
///   [ I, −γI; −γ Mᵢ⁻¹Kᵢᵢ, I − γ Mᵢ⁻¹Dᵢᵢ ],
/// which is solved by eliminating qᵢ: S = I − γ Mᵢ⁻¹Dᵢᵢ − γ² Mᵢ⁻¹Kᵢᵢ. Of any other system it keeps the
/// diagonal of J.
class BlockPreconditioner {
 public:
  /// `system` outlives the preconditioner.
  explicit BlockPreconditioner(const OdeSystem& system);

  /// Takes the blocks of J at (t, y).
  void evaluate(double t, ConstVectorRef y, Work& work);

  /// Makes the inverses for γ from the blocks that were taken last. False where one is singular or not
  /// finite; the preconditioner then cannot be used.
  bool factorise(double gamma);

  /// z = P⁻¹ r. `r` and `z` must not overlap.
  void solve(ConstVectorRef r, VectorRef z) const;

 private:
  Index block_count() const;
  std::uint64_t revision() const;
  void make_pattern();
  void take_blocks(const SparseMatrix& matrix, std::vector<double>& blocks) const;
  template <int Size>
  bool factorise_blocks();
  template <int Size>
  void solve_blocks(ConstVectorRef r, VectorRef z) const;

  const OdeSystem& system_;
  const SecondOrderSystem* second_order_;
  Index block_size_;
  PatternWatch watch_;
  double gamma_ = 0.0;
  SparseMatrix matrix_;            ///< room for K and D, or for J
  std::vector<int> places_;        ///< where in its values the entries of the blocks are, −1: not stored
  std::vector<double> stiffness_;  ///< M⁻¹K by blocks, or the diagonal of J
  std::vector<double> damping_;    ///< M⁻¹D by blocks
  std::vector<double> inverses_;   ///< S⁻¹ by blocks, or the inverse diagonal
};

}  // namespace fw::oracles
