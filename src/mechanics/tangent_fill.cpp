#include "mechanics/tangent_fill.hpp"

#include <fmt/format.h>

#include "core/error.hpp"

namespace fw::mechanics {

void require_pattern(const SparseMatrix& matrix, Index size, Index nonzeros, const char* name) {
  if (matrix.rows() != size || matrix.cols() != size || !matrix.isCompressed() ||
      matrix.nonZeros() != nonzeros) {
    throw InputError(
        fmt::format("{}: found {} x {} with {} entries, expected {} x {} with {} compressed entries, as the "
                    "pattern has them",
                    name, matrix.rows(), matrix.cols(), matrix.nonZeros(), size, size, nonzeros));
  }
}

}  // namespace fw::mechanics
