#include "text/closest_name.hpp"

#include <gtest/gtest.h>

namespace fw {
namespace {

TEST(EditDistance, CountsInsertionsDeletionsSubstitutionsAndSwaps) {
  EXPECT_EQ(edit_distance("", ""), 0u);
  EXPECT_EQ(edit_distance("", "abc"), 3u);
  EXPECT_EQ(edit_distance("abc", ""), 3u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("stiffness", "stifness"), 1u);
  EXPECT_EQ(edit_distance("mass", "msas"), 1u);
  EXPECT_EQ(edit_distance("ca", "abc"), 3u);  // 2 only if a swapped pair could be edited again
}

TEST(ClosestName, FindsMisspellingsButNotOtherWords) {
  const std::vector<std::string> known = {"stiffness", "damping", "rest_length", "law", "xy"};
  EXPECT_EQ(closest_name("stifness", known), "stiffness");
  EXPECT_EQ(closest_name("Damping", known), "damping");
  EXPECT_EQ(closest_name("restlength", known), "rest_length");
  EXPECT_EQ(closest_name("lwa", known), "law");
  EXPECT_EQ(closest_name("viscosity", known), std::nullopt);
  EXPECT_EQ(closest_name("xz", known), std::nullopt);
  EXPECT_EQ(closest_name("mass", {}), std::nullopt);
  EXPECT_EQ(closest_name(std::string(1000000, 'x'), known), std::nullopt);
}

TEST(DidYouMean, IsASentenceOrNothing) {
  EXPECT_EQ(did_you_mean("rk5", {"rk4", "heun"}), "; did you mean \"rk4\"?");
  EXPECT_EQ(did_you_mean("leapfrog", {"rk4", "heun"}), "");
}

}  // namespace
}  // namespace fw
