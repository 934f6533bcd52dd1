#pragma once

#include <cstddef>
#include <vector>

#include "mechanics/block_pattern.hpp"
#include "mechanics/central_force_tangent.hpp"

namespace fw::mechanics {

/// Throws InputError that names the matrix unless it has the given size and number of compressed entries.
void require_pattern(const SparseMatrix& matrix, Index size, Index nonzeros, const char* name);

/// Fills K or D: `block` picks the block out of an element's tangent.
template <class Block>
struct TangentFill {
  const BlockPattern& pattern;
  const std::vector<char>& fixed;
  double* values;
  Block block;

  bool is_free(int i) const { return fixed[3 * static_cast<std::size_t>(i)] == 0; }

  void point(int i, const auto& tangent) const {
    if (is_free(i)) add_block(values, pattern.diagonal(i), 1.0, block(tangent));
  }
  void pair(std::size_t e, int i, int j, const CentralForceTangent& tangent) const {
    const Matrix3 k = block(tangent);
    if (is_free(i)) {
      add_block(values, pattern.diagonal(i), -1.0, k);
      add_block(values, pattern.upper(e, j), 1.0, k);
    }
    if (is_free(j)) {
      add_block(values, pattern.diagonal(j), -1.0, k);
      add_block(values, pattern.lower(e, i), 1.0, k);
    }
  }
};

}  // namespace fw::mechanics
