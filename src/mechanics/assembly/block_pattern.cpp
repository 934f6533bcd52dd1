#include "mechanics/assembly/block_pattern.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/error.hpp"

namespace fw::mechanics {

namespace {

/// Calls `visit(first node, arity)` for each element with neighbours.
template <class Visit>
void for_each_clique(const std::vector<Cliques>& cliques, Visit visit) {
  for (const Cliques& batch : cliques) {
    if (batch.arity < 2) continue;
    const auto arity = static_cast<std::size_t>(batch.arity);
    for (std::size_t k = 0; k < batch.nodes.size(); k += arity) visit(batch.nodes.data() + k, arity);
  }
}

std::size_t count_pairs(const std::vector<Cliques>& cliques) {
  std::size_t pairs = 0;
  for (const Cliques& batch : cliques)
    pairs += batch.nodes.size() * static_cast<std::size_t>(batch.arity - 1);
  return pairs;
}

void require_entries(const SparseMatrix& matrix, Index size, Index nonzeros, std::string_view name) {
  if (matrix.rows() != size || matrix.cols() != size || !matrix.isCompressed() ||
      matrix.nonZeros() != nonzeros) {
    throw InputError(
        fmt::format("{}: found {} x {} with {} entries, expected {} x {} with {} compressed entries, as the "
                    "pattern has them",
                    name, matrix.rows(), matrix.cols(), matrix.nonZeros(), size, size, nonzeros));
  }
}

}  // namespace

BlockPattern::BlockPattern(int particles, const std::vector<Cliques>& cliques, std::uint64_t revision)
    : revision_(revision) {
  const std::size_t n = size(particles);
  const std::size_t pairs = count_pairs(cliques);
  const std::size_t largest = 2 * (9 * (n + pairs) + 3 * n);
  if (largest > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    throw InputError(
        fmt::format("a Jacobian of {} particles and {} pairs of neighbours has up to {} entries, expected at "
                    "most {} (32-bit indices); "
                    "use a method without assembled matrices",
                    n, pairs / 2, largest, std::numeric_limits<int>::max()));
  }
  // Counting sort of the pairs by their second particle, each particle first among its own neighbours.
  start_.assign(n + 1, 1);
  start_[0] = 0;
  for_each_clique(cliques, [&](const int* nodes, std::size_t arity) {
    for (std::size_t a = 0; a < arity; ++a) start_[size(nodes[a]) + 1] += static_cast<int>(arity) - 1;
  });
  for (std::size_t i = 0; i < n; ++i) start_[i + 1] += start_[i];
  neighbours_.resize(n + pairs);
  std::vector<int> next(start_.begin(), start_.end() - 1);
  for (std::size_t i = 0; i < n; ++i) neighbours_[size(next[i]++)] = static_cast<int>(i);
  for_each_clique(cliques, [&](const int* nodes, std::size_t arity) {
    for (std::size_t a = 0; a < arity; ++a) {
      for (std::size_t b = 0; b < arity; ++b) {
        if (a != b) neighbours_[size(next[size(nodes[a])]++)] = nodes[b];
      }
    }
  });
  // Several elements may join the same pair: sort, drop repetitions and close the gaps.
  auto end_of_kept = neighbours_.begin();
  int begin = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const auto from = neighbours_.begin() + begin;
    const auto to = neighbours_.begin() + start_[i + 1];
    std::sort(from, to);
    begin = start_[i + 1];
    start_[i] = static_cast<int>(end_of_kept - neighbours_.begin());
    end_of_kept = std::copy(from, std::unique(from, to), end_of_kept);
  }
  start_[n] = static_cast<int>(end_of_kept - neighbours_.begin());
  neighbours_.erase(end_of_kept, neighbours_.end());

  diagonal_.resize(n);
  jacobian_slots_ = FirstOrderSlots(3 * particles, static_cast<int>(tangent_nonzeros()));
  for (int i = 0; i < particles; ++i) diagonal_[size(i)] = slot_of(i, i);
  off_diagonal_.resize(cliques.size());
  for (std::size_t k = 0; k < cliques.size(); ++k) {
    const auto arity = static_cast<std::size_t>(cliques[k].arity);
    const std::vector<int>& nodes = cliques[k].nodes;
    off_diagonal_[k].reserve(nodes.size() * (arity - 1));
    for (std::size_t e = 0; e < nodes.size(); e += arity) {
      for (std::size_t a = 0; a < arity; ++a) {
        for (std::size_t b = 0; b < arity; ++b) {
          if (a != b) off_diagonal_[k].push_back(slot_of(nodes[e + a], nodes[e + b]));
        }
      }
    }
  }
}

int BlockPattern::slot_of(int row, int column) const {
  const auto begin = neighbours_.begin() + start_[size(column)];
  const auto end = neighbours_.begin() + start_[size(column) + 1];
  const auto position = std::lower_bound(begin, end, row) - begin;
  return 9 * start_[size(column)] + 3 * static_cast<int>(position);
}

int BlockPattern::jacobian_unit(int c) const {
  const int j = c / 3;
  return jacobian_slots_.unit(9 * start_[size(j)] + (c % 3) * stride(j), c);
}

SparseMatrix BlockPattern::tangent() const {
  const Index n = 3 * particles();
  SparseMatrix matrix(n, n);
  matrix.resizeNonZeros(tangent_nonzeros());
  int* outer = matrix.outerIndexPtr();
  int* inner = matrix.innerIndexPtr();
  *outer++ = 0;
  for (int j = 0; j < static_cast<int>(particles()); ++j) {
    for (int b = 0; b < 3; ++b) {
      for (int p = start_[size(j)]; p < start_[size(j) + 1]; ++p) {
        for (int a = 0; a < 3; ++a) *inner++ = 3 * neighbours_[size(p)] + a;
      }
      outer[0] = outer[-1] + stride(j);
      ++outer;
    }
  }
  matrix.coeffs().setZero();
  return matrix;
}

SparseMatrix BlockPattern::jacobian() const {
  return FirstOrderJacobian(tangent()).pattern();
}

void BlockPattern::require_tangent(const SparseMatrix& matrix, std::string_view name) const {
  require_entries(matrix, 3 * particles(), tangent_nonzeros(), name);
}

void BlockPattern::require_jacobian(const SparseMatrix& matrix, std::string_view name) const {
  require_entries(matrix, 6 * particles(), jacobian_slots_.entries(), name);
}

}  // namespace fw::mechanics
