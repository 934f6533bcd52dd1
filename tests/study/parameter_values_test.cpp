#include "study/parameter_values.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace fw::study {
namespace {

using Indices = std::vector<std::size_t>;

TEST(SpreadIndices, KeepsTheFirstAndTheLast) {
  EXPECT_EQ(spread_indices(10, 4), (Indices{0, 3, 6, 9}));
  EXPECT_EQ(spread_indices(10, 3), (Indices{0, 4, 9}));
  EXPECT_EQ(spread_indices(7, 2), (Indices{0, 6}));
  EXPECT_EQ(spread_indices(7, 1), (Indices{0}));
}

TEST(SpreadIndices, KeepsAllWhereThereAreNoMore) {
  EXPECT_EQ(spread_indices(3, 3), (Indices{0, 1, 2}));
  EXPECT_EQ(spread_indices(3, 100), (Indices{0, 1, 2}));
  EXPECT_TRUE(spread_indices(0, 5).empty());
}

TEST(SpreadIndices, NeverRepeatsAnEntry) {
  for (std::size_t size = 1; size < 40; ++size) {
    for (std::size_t most = 1; most < 45; ++most) {
      const Indices kept = spread_indices(size, most);
      EXPECT_EQ(kept.size(), std::min(size, most));
      for (std::size_t k = 1; k < kept.size(); ++k) EXPECT_LT(kept[k - 1], kept[k]);
    }
  }
}

TEST(ThinnedOut, MovesTheEntriesThatStay) {
  std::vector<std::unique_ptr<int>> entries;
  for (int k = 0; k < 5; ++k) entries.push_back(std::make_unique<int>(k));
  const auto kept = thinned_out(std::move(entries), 3);
  ASSERT_EQ(kept.size(), 3u);
  EXPECT_EQ(*kept[0], 0);
  EXPECT_EQ(*kept[1], 2);
  EXPECT_EQ(*kept[2], 4);
}

}  // namespace
}  // namespace fw::study
