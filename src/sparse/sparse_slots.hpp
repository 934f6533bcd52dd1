#pragma once

#include <vector>

#include "core/types.hpp"

namespace fw::sparse {

// Places ("slots") of entries in the value array of a compressed column matrix whose rows are sorted.

/// Slot of entry (row, column), or −1 where the pattern has none. O(log of the column's entries).
int find_slot(const SparseMatrix& A, Index row, Index column);

/// Slot of entry (row, column). Throws std::logic_error that names the entry where the pattern has none.
int slot_of(const SparseMatrix& A, Index row, Index column);

/// Slot of every diagonal entry of a square matrix; throws std::logic_error where one is missing.
std::vector<int> diagonal_slots(const SparseMatrix& A);

/// For every stored entry (i, j), in the order of the values, the slot of (j, i). Throws std::logic_error
/// where the pattern is not symmetric.
std::vector<int> transpose_slots(const SparseMatrix& A);

/// Adds `value` to every diagonal entry of a square matrix; throws std::logic_error where one is missing.
void add_to_diagonal(SparseMatrix& A, double value);

/// Whether two compressed matrices have the same size and the same stored entries (values may differ).
bool same_pattern(const SparseMatrix& A, const SparseMatrix& B);

}  // namespace fw::sparse
