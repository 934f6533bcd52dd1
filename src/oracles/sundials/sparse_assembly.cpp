#include "oracles/sundials/sparse_assembly.hpp"

#include <algorithm>

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
  for (const auto& [row, column] : places) {
    const int* first = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[column];
    const int* last = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[column + 1];
    slots_.push_back(std::lower_bound(first, last, static_cast<int>(row)) - matrix_.innerIndexPtr());
  }
}

void SparseAssembly::clear() {
  matrix_.coeffs().setZero();
  next_ = 0;
}

}  // namespace fw::oracles::detail
