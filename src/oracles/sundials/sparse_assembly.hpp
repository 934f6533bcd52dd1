#pragma once

#include <utility>
#include <vector>

#include "core/types.hpp"

namespace fw::oracles::detail {

/// A sparse matrix that is a sum of entries which come in the same order each time: the pattern is made once,
/// afterwards values are added where they belong without a search.
class SparseAssembly {
 public:
  /// (row, column) of each entry in the order of the values to come; places may repeat.
  SparseAssembly(Index rows, Index columns, const std::vector<std::pair<Index, Index>>& places);

  /// Starts anew: all values zero.
  void clear();
  /// Adds the value of the next place.
  void add(double value) { matrix_.valuePtr()[slots_[next_++]] += value; }

  const SparseMatrix& matrix() const { return matrix_; }

 private:
  SparseMatrix matrix_;
  std::vector<Index> slots_;  ///< position of each entry among the matrix's values
  std::size_t next_ = 0;
};

/// Calls `entry(row, column, value)` for the stored entries, column by column.
template <class Entry>
void for_each_entry(const SparseMatrix& matrix, Entry entry) {
  for (Index j = 0; j < matrix.outerSize(); ++j) {
    for (SparseMatrix::InnerIterator it(matrix, j); it; ++it) entry(it.row(), it.col(), it.value());
  }
}

}  // namespace fw::oracles::detail
