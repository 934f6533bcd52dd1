#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/types.hpp"
#include "mechanics/elements/central_force_tangent.hpp"
#include "ode/first_order_jacobian.hpp"

namespace fw::mechanics {

/// Where in the value array of a matrix a 3×3 block lives: entry (a, b) of the block at `first + b·stride +
/// a`.
struct BlockSlot {
  int first = 0;
  int stride = 0;
};

/// The nodes of elements that couple all their particles with one another.
struct Cliques {
  int arity = 1;           ///< nodes per element
  std::vector<int> nodes;  ///< element after element; may be empty for arity 1, which couples nothing
};

/// The sparsity of the tangent matrices of force elements, made of 3×3 blocks (one per particle, two per pair
/// of neighbours: particles that share an element), with the place of every element's blocks worked out
/// beforehand: filling a matrix is then one walk over the elements, without a search.
///
/// In compressed columns the three columns of particle j have the same 3·(1 + neighbours) rows. The slots of
/// the first-order system's Jacobian follow from those of K (`FirstOrderSlots`) and need no memory.
///
/// Memory: 2 integers per particle, 4 per spring; 2 N (N − 1) per element with N nodes.
class BlockPattern {
 public:
  /// One entry of `cliques` per batch; nodes of an element are different and valid. Throws InputError if a
  /// matrix would have more entries than its 32-bit indices can count.
  BlockPattern(int particles, const std::vector<Cliques>& cliques, std::uint64_t revision = 0);

  /// Counts the patterns that a system has had: a matrix of another revision has another structure.
  std::uint64_t revision() const { return revision_; }
  /// Whether the matrices have the same structure.
  bool has_same_blocks(const BlockPattern& other) const {
    return start_ == other.start_ && neighbours_ == other.neighbours_;
  }

  /// 3n×3n zeros.
  SparseMatrix tangent() const;
  /// 6n×6n zeros.
  SparseMatrix jacobian() const;

  /// Throw InputError that names the matrix unless it has the size and the number of compressed entries of
  /// `tangent()` or `jacobian()`.
  void require_tangent(const SparseMatrix& matrix, std::string_view name) const;
  void require_jacobian(const SparseMatrix& matrix, std::string_view name) const;

  Index tangent_nonzeros() const { return 9 * static_cast<Index>(neighbours_.size()); }
  Index particles() const { return static_cast<Index>(diagonal_.size()); }

  /// Block (i, i) of a tangent matrix.
  BlockSlot diagonal(int i) const { return {diagonal_[size(i)], stride(i)}; }
  /// Block (i, j) of element e of a batch, i and j its nodes number a and b.
  template <std::size_t N>
  BlockSlot slot(std::size_t batch, std::size_t e, std::size_t a, std::size_t b,
                 const std::array<int, N>& nodes) const {
    if (a == b) return diagonal(nodes[a]);
    return {off_diagonal_[batch][(N * e + a) * (N - 1) + (b < a ? b : b - 1)], stride(nodes[b])};
  }

  /// The block M⁻¹K of the Jacobian, from the slot of K in block column j.
  BlockSlot jacobian_position(BlockSlot slot, int j) const {
    return moved(slot, j, [this](int k, int c) { return jacobian_slots_.stiffness(k, c); });
  }
  /// The block M⁻¹D of the Jacobian, from the slot of D in block column j.
  BlockSlot jacobian_velocity(BlockSlot slot, int j) const {
    return moved(slot, j, [this](int k, int c) { return jacobian_slots_.damping(k, c); });
  }
  /// Entry (c, 3n + c) of the Jacobian, which is 1 where ẋ = v.
  int jacobian_unit(int c) const;

 private:
  static std::size_t size(int i) { return static_cast<std::size_t>(i); }
  int degree(int i) const { return start_[size(i) + 1] - start_[size(i)]; }
  int stride(int i) const { return 3 * degree(i); }
  int slot_of(int row, int column) const;
  /// A block of the tangents in block column j where `slot_in_jacobian(slot, column)` puts its entries.
  template <class Slot>
  static BlockSlot moved(BlockSlot slot, int j, Slot slot_in_jacobian) {
    const int first = slot_in_jacobian(slot.first, 3 * j);
    return {first, slot_in_jacobian(slot.first + slot.stride, 3 * j + 1) - first};
  }

  std::vector<int> start_;       ///< first neighbour of each particle in `neighbours_`
  std::vector<int> neighbours_;  ///< ascending, each particle among its own
  std::vector<int> diagonal_;
  std::vector<std::vector<int>> off_diagonal_;  ///< per batch N (N − 1) slots per element, row by row
  FirstOrderSlots jacobian_slots_;
  std::uint64_t revision_ = 0;
};

/// Adds `factor`·`block` to the values of a matrix.
inline void add_block(double* values, BlockSlot slot, double factor, const Matrix3& block) {
  double* column = values + slot.first;
  for (int b = 0; b < 3; ++b, column += slot.stride) {
    for (int a = 0; a < 3; ++a) column[a] += factor * block(a, b);
  }
}

}  // namespace fw::mechanics
