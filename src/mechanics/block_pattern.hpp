#pragma once

#include <cstddef>
#include <vector>

#include "core/types.hpp"
#include "mechanics/central_force_tangent.hpp"

namespace fw::mechanics {

/// Where in the value array of a matrix a 3×3 block lives: entry (a, b) of the block at `first + b·stride +
/// a`.
struct BlockSlot {
  int first = 0;
  int stride = 0;
};

/// The sparsity of the tangent matrices of a spring network, made of 3×3 blocks (one per particle, two per
/// pair of neighbours), with the place of every spring's blocks worked out beforehand: filling a matrix is
/// then one walk over the springs, without a search.
///
/// In compressed columns the three columns of particle j have the same 3·(1 + neighbours) rows. The Jacobian
/// of the first-order system, [[0, I], [M⁻¹K, M⁻¹D]], has the same columns twice, each with one entry above
/// (the diagonal on the left, the unit entry on the right), so its slots follow from those of K and need no
/// memory.
///
/// Memory: 2 integers per particle, 4 per spring.
class BlockPattern {
 public:
  /// From the end points of the springs, which must be valid. Throws InputError if a matrix would have more
  /// entries than its 32-bit indices can count.
  BlockPattern(int particles, const std::vector<int>& first, const std::vector<int>& second);

  /// 3n×3n zeros.
  SparseMatrix tangent() const;
  /// 6n×6n zeros.
  SparseMatrix jacobian() const;

  Index tangent_nonzeros() const { return 9 * static_cast<Index>(neighbours_.size()); }
  Index jacobian_nonzeros() const { return 2 * (tangent_nonzeros() + 3 * particles()); }
  Index particles() const { return static_cast<Index>(diagonal_.size()); }

  /// Block (i, i) of a tangent matrix.
  BlockSlot diagonal(int i) const { return {diagonal_[size(i)], stride(i)}; }
  /// Block (i, j) of spring e = (i, j).
  BlockSlot upper(std::size_t e, int j) const { return {upper_[e], stride(j)}; }
  /// Block (j, i) of spring e = (i, j).
  BlockSlot lower(std::size_t e, int i) const { return {lower_[e], stride(i)}; }

  /// The block M⁻¹K of the Jacobian, from the slot of K in block column j.
  BlockSlot jacobian_position(BlockSlot slot, int j) const {
    return {slot.first + 3 * j + 1, slot.stride + 1};
  }
  /// The block M⁻¹D of the Jacobian, from the slot of D in block column j.
  BlockSlot jacobian_velocity(BlockSlot slot, int j) const {
    return {static_cast<int>(tangent_nonzeros() + 3 * particles()) + slot.first + 3 * j + 1, slot.stride + 1};
  }
  /// Entry (c, 3n + c) of the Jacobian, which is 1 where ẋ = v.
  Index jacobian_unit(Index c) const;

 private:
  static std::size_t size(int i) { return static_cast<std::size_t>(i); }
  int degree(int i) const { return start_[size(i) + 1] - start_[size(i)]; }
  int stride(int i) const { return 3 * degree(i); }
  int slot_of(int row, int column) const;

  std::vector<int> start_;       ///< first neighbour of each particle in `neighbours_`
  std::vector<int> neighbours_;  ///< ascending, each particle among its own
  std::vector<int> diagonal_;
  std::vector<int> upper_;
  std::vector<int> lower_;
};

/// Adds `factor`·`block` to the values of a matrix.
inline void add_block(double* values, BlockSlot slot, double factor, const Matrix3& block) {
  double* column = values + slot.first;
  for (int b = 0; b < 3; ++b, column += slot.stride) {
    for (int a = 0; a < 3; ++a) column[a] += factor * block(a, b);
  }
}

}  // namespace fw::mechanics
