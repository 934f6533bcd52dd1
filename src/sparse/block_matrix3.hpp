#pragma once

#include <vector>

#include "core/types.hpp"

namespace fw::sparse {

/// A square sparse matrix of 3×3 blocks, as the tangents of particles in space are, in compressed block
/// columns: one index for nine values. The pattern is made once and holds every diagonal block; new values
/// are taken without allocation and without a search.
///
/// It is made of a matrix in compressed columns and has no way back: systems fill compressed columns in
/// place, and direct solvers read those (decision 0063).
class BlockMatrix3 {
 public:
  using Block = Eigen::Map<const Eigen::Matrix3d>;

  BlockMatrix3() = default;

  /// Zeros in every 3×3 block in which the pattern of `A` has an entry, and in the diagonal ones. `A` is
  /// square and compressed with sorted rows, its size a multiple of three; throws std::logic_error otherwise.
  explicit BlockMatrix3(const SparseMatrix& A);

  Index rows() const { return 3 * block_rows(); }
  Index block_rows() const { return static_cast<Index>(diagonal_.size()); }
  Index block_count() const { return static_cast<Index>(row_.size()); }

  /// The values of `A`, whose pattern is that of the constructor's; where `A` has no entry the block has a
  /// zero.
  void take_values(const SparseMatrix& A);

  /// Block (i, i).
  Block diagonal(Index i) const { return block(diagonal_[static_cast<std::size_t>(i)]); }

  /// y = Aᵀx, which is A x for a symmetric matrix: three entries of y at a time are gathered, each summed in
  /// the order of the rows (the sums of Eigen's `A.transpose() * x`, bit for bit). `x` and `y` do not
  /// overlap.
  void transposed_product(ConstVectorRef x, VectorRef y) const;

 private:
  Block block(int k) const { return Block(values_.data() + 9 * static_cast<std::size_t>(k)); }

  std::vector<int> start_;      ///< first block of each block column
  std::vector<int> row_;        ///< block row of each block, ascending in a column
  std::vector<int> diagonal_;   ///< the block on the diagonal of each block column
  std::vector<int> place_;      ///< in `values_`, of each entry of A
  std::vector<double> values_;  ///< block after block, each by columns
};

}  // namespace fw::sparse
