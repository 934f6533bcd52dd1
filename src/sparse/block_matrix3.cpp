#include "sparse/block_matrix3.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace fw::sparse {

BlockMatrix3::BlockMatrix3(const SparseMatrix& A) {
  if (A.rows() != A.cols() || A.cols() % 3 != 0 || !A.isCompressed()) {
    throw std::logic_error(
        fmt::format("matrix of 3 x 3 blocks: found {} x {}{}, expected a square compressed matrix, its size "
                    "a multiple of 3",
                    A.rows(), A.cols(), A.isCompressed() ? "" : ", not compressed"));
  }
  const int n = static_cast<int>(A.cols()) / 3;
  start_.assign(1, 0);
  diagonal_.reserve(static_cast<std::size_t>(n));
  place_.resize(static_cast<std::size_t>(A.nonZeros()));
  std::vector<int> rows;  // of one block column
  for (int j = 0; j < n; ++j) {
    rows.assign(1, j);
    for (int k = A.outerIndexPtr()[3 * j]; k < A.outerIndexPtr()[3 * j + 3]; ++k) {
      const int row = A.innerIndexPtr()[k] / 3;
      if (rows.back() != row) rows.push_back(row);
    }
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    const int first = start_.back();
    const auto block_of = [&](int row) {
      return first + static_cast<int>(std::lower_bound(rows.begin(), rows.end(), row) - rows.begin());
    };
    diagonal_.push_back(block_of(j));
    for (int column = 3 * j; column < 3 * j + 3; ++column) {
      for (int k = A.outerIndexPtr()[column]; k < A.outerIndexPtr()[column + 1]; ++k) {
        const int row = A.innerIndexPtr()[k];
        place_[static_cast<std::size_t>(k)] = 9 * block_of(row / 3) + 3 * (column % 3) + row % 3;
      }
    }
    row_.insert(row_.end(), rows.begin(), rows.end());
    start_.push_back(static_cast<int>(row_.size()));
  }
  values_.assign(9 * row_.size(), 0.0);
}

void BlockMatrix3::take_values(const SparseMatrix& A) {
  for (std::size_t k = 0; k < place_.size(); ++k)
    values_[static_cast<std::size_t>(place_[k])] = A.valuePtr()[k];
}

void BlockMatrix3::transposed_product(ConstVectorRef x, VectorRef y) const {
  const double* b = values_.data();
  for (std::size_t j = 0; j < diagonal_.size(); ++j) {
    double y0 = 0.0, y1 = 0.0, y2 = 0.0;
    for (int k = start_[j]; k < start_[j + 1]; ++k, b += 9) {
      const double* part = x.data() + 3 * row_[static_cast<std::size_t>(k)];
      for (int a = 0; a < 3; ++a) {
        y0 += b[a] * part[a];
        y1 += b[3 + a] * part[a];
        y2 += b[6 + a] * part[a];
      }
    }
    double* out = y.data() + 3 * j;
    out[0] = y0;
    out[1] = y1;
    out[2] = y2;
  }
}

}  // namespace fw::sparse
