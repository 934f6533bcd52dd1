#include "sparse/sparse_slots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace fw::sparse {

int find_slot(const SparseMatrix& A, Index row, Index column) {
  const int* begin = A.innerIndexPtr() + A.outerIndexPtr()[column];
  const int* end = A.innerIndexPtr() + A.outerIndexPtr()[column + 1];
  const int* entry = std::lower_bound(begin, end, static_cast<int>(row));
  if (entry == end || *entry != static_cast<int>(row)) return -1;
  return static_cast<int>(entry - A.innerIndexPtr());
}

int slot_of(const SparseMatrix& A, Index row, Index column) {
  const int slot = find_slot(A, row, column);
  if (slot < 0) {
    throw std::logic_error(
        fmt::format("sparse {} x {} matrix: found no entry ({}, {}) in its pattern, expected one", A.rows(),
                    A.cols(), row, column));
  }
  return slot;
}

std::vector<int> diagonal_slots(const SparseMatrix& A) {
  std::vector<int> slots(static_cast<std::size_t>(A.cols()));
  for (Index column = 0; column < A.cols(); ++column) {
    slots[static_cast<std::size_t>(column)] = slot_of(A, column, column);
  }
  return slots;
}

std::vector<int> transpose_slots(const SparseMatrix& A) {
  std::vector<int> slots(static_cast<std::size_t>(A.nonZeros()));
  for (Index column = 0; column < A.cols(); ++column) {
    for (int k = A.outerIndexPtr()[column]; k < A.outerIndexPtr()[column + 1]; ++k) {
      slots[static_cast<std::size_t>(k)] = slot_of(A, column, A.innerIndexPtr()[k]);
    }
  }
  return slots;
}

void add_to_diagonal(SparseMatrix& A, double value) {
  for (Index column = 0; column < A.cols(); ++column) A.valuePtr()[slot_of(A, column, column)] += value;
}

bool same_pattern(const SparseMatrix& A, const SparseMatrix& B) {
  return A.rows() == B.rows() && A.cols() == B.cols() && A.nonZeros() == B.nonZeros() &&
         std::equal(A.outerIndexPtr(), A.outerIndexPtr() + A.outerSize() + 1, B.outerIndexPtr()) &&
         std::equal(A.innerIndexPtr(), A.innerIndexPtr() + A.nonZeros(), B.innerIndexPtr());
}

}  // namespace fw::sparse
