#include "mechanics/block_pattern.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/error.hpp"

namespace fw::mechanics {

BlockPattern::BlockPattern(int particles, const std::vector<int>& first, const std::vector<int>& second) {
  const std::size_t n = size(particles);
  const std::size_t springs = first.size();
  const std::size_t largest = 2 * (9 * (n + 2 * springs) + 3 * n);
  if (largest > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    throw InputError(
        fmt::format("a Jacobian of {} particles and {} springs has up to {} entries, expected at most {} "
                    "(32-bit indices); "
                    "use a method without assembled matrices",
                    n, springs, largest, std::numeric_limits<int>::max()));
  }
  // Counting sort of the springs by end point, each particle first among its own neighbours.
  start_.assign(n + 1, 1);
  start_[0] = 0;
  for (std::size_t e = 0; e < springs; ++e) {
    ++start_[size(first[e]) + 1];
    ++start_[size(second[e]) + 1];
  }
  for (std::size_t i = 0; i < n; ++i) start_[i + 1] += start_[i];
  neighbours_.resize(n + 2 * springs);
  std::vector<int> next(start_.begin(), start_.end() - 1);
  for (std::size_t i = 0; i < n; ++i) neighbours_[size(next[i]++)] = static_cast<int>(i);
  for (std::size_t e = 0; e < springs; ++e) {
    neighbours_[size(next[size(first[e])]++)] = second[e];
    neighbours_[size(next[size(second[e])]++)] = first[e];
  }
  // Several springs may join the same pair: sort, drop repetitions and close the gaps.
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
  for (int i = 0; i < particles; ++i) diagonal_[size(i)] = slot_of(i, i);
  upper_.resize(springs);
  lower_.resize(springs);
  for (std::size_t e = 0; e < springs; ++e) {
    upper_[e] = slot_of(first[e], second[e]);
    lower_[e] = slot_of(second[e], first[e]);
  }
}

int BlockPattern::slot_of(int row, int column) const {
  const auto begin = neighbours_.begin() + start_[size(column)];
  const auto end = neighbours_.begin() + start_[size(column) + 1];
  const auto position = std::lower_bound(begin, end, row) - begin;
  return 9 * start_[size(column)] + 3 * static_cast<int>(position);
}

Index BlockPattern::jacobian_unit(Index c) const {
  const auto j = static_cast<int>(c / 3);
  const BlockSlot slot = jacobian_velocity({9 * start_[size(j)], stride(j)}, j);
  return slot.first + (c % 3) * slot.stride - 1;
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
  const auto n = static_cast<int>(3 * particles());
  SparseMatrix matrix(2 * n, 2 * n);
  matrix.resizeNonZeros(jacobian_nonzeros());
  int* outer = matrix.outerIndexPtr();
  int* inner = matrix.innerIndexPtr();
  *outer++ = 0;
  for (int column = 0; column < 2 * n; ++column) {
    const int c = column % n;
    const int j = c / 3;
    *inner++ = c;
    for (int p = start_[size(j)]; p < start_[size(j) + 1]; ++p) {
      for (int a = 0; a < 3; ++a) *inner++ = n + 3 * neighbours_[size(p)] + a;
    }
    outer[0] = outer[-1] + stride(j) + 1;
    ++outer;
  }
  matrix.coeffs().setZero();
  return matrix;
}

}  // namespace fw::mechanics
