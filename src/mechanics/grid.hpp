#pragma once

#include <array>
#include <cstddef>

namespace fw::mechanics {

/// Points in a regular arrangement of `counts[0]` × `counts[1]` × `counts[2]`, numbered with the first index
/// running fastest.
struct Grid {
  std::array<int, 3> counts{1, 1, 1};  ///< points along each axis, ≥ 1

  /// The number of point (i, j, k).
  int index(int i, int j, int k) const { return i + counts[0] * (j + counts[1] * k); }

  /// The number of point (i, j, k) + offset; −1 where the grid has no such point.
  int neighbour(int i, int j, int k, const std::array<int, 3>& offset) const {
    const std::array<int, 3> at{i + offset[0], j + offset[1], k + offset[2]};
    for (std::size_t a = 0; a < 3; ++a) {
      if (at[a] < 0 || at[a] >= counts[a]) return -1;
    }
    return index(at[0], at[1], at[2]);
  }

  /// Calls `visit(i, j, k)` for each point in the order of the numbers.
  template <class Visit>
  void for_each_point(Visit visit) const {
    for (int k = 0; k < counts[2]; ++k) {
      for (int j = 0; j < counts[1]; ++j) {
        for (int i = 0; i < counts[0]; ++i) visit(i, j, k);
      }
    }
  }
};

}  // namespace fw::mechanics
