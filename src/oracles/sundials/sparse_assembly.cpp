#include "oracles/sundials/sparse_assembly.hpp"

#include "sparse/sparse_slots.hpp"

namespace fw::oracles::detail {

SparseAssembly::SparseAssembly(Index rows, Index columns, const std::vector<std::pair<Index, Index>>& places)
    : matrix_(rows, columns) {
  std::vector<Eigen::Triplet<double, int>> entries;
  entries.reserve(places.size());
  for (const auto& [row, column] : places) {
    entries.emplace_back(static_cast<int>(row), static_cast<int>(column), 0.0);
  }
  matrix_.setFromTriplets(entries.begin(), entries.end());
  matrix_.makeCompressed();
  slots_.reserve(places.size());
  for (const auto& [row, column] : places) slots_.push_back(sparse::slot_of(matrix_, row, column));
}

void SparseAssembly::clear() {
  matrix_.coeffs().setZero();
  next_ = 0;
}

}  // namespace fw::oracles::detail
