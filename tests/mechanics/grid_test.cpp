#include "mechanics/grid.hpp"

#include <gtest/gtest.h>

#include <set>

namespace fw::mechanics {
namespace {

TEST(Grid, NumbersItsPointsInTheOrderOfTheWalk) {
  const Grid grid{{4, 3, 2}};
  int expected = 0;
  grid.for_each_point([&](int i, int j, int k) { EXPECT_EQ(grid.index(i, j, k), expected++); });
  EXPECT_EQ(expected, 24);
}

TEST(Grid, FindsNeighboursInsideAndNoneOutside) {
  const Grid grid{{4, 3, 2}};
  EXPECT_EQ(grid.neighbour(1, 1, 0, {1, -1, 1}), grid.index(2, 0, 1));
  EXPECT_EQ(grid.neighbour(3, 1, 0, {1, 0, 0}), -1);
  EXPECT_EQ(grid.neighbour(0, 1, 0, {-1, 0, 0}), -1);
  EXPECT_EQ(grid.neighbour(0, 2, 0, {0, 1, 0}), -1);
  EXPECT_EQ(grid.neighbour(0, 0, 0, {0, -1, 0}), -1);
  EXPECT_EQ(grid.neighbour(0, 0, 1, {0, 0, 1}), -1);
  EXPECT_EQ(grid.neighbour(0, 0, 0, {0, 0, -1}), -1);
}

TEST(Grid, JoinsAsManyPairsAsItHas) {
  const Grid grid{{5, 4, 3}};
  std::set<std::pair<int, int>> pairs;
  grid.for_each_point([&](int i, int j, int k) {
    const int other = grid.neighbour(i, j, k, {-1, 2, 1});
    if (other >= 0) pairs.emplace(grid.index(i, j, k), other);
  });
  EXPECT_EQ(pairs.size(), 4u * 2u * 2u);
}

}  // namespace
}  // namespace fw::mechanics
