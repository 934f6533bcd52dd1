#include "formula/vector_function.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/error.hpp"

namespace fw::formula {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

VectorFunction table(std::vector<double> t, std::vector<Vec3<double>> value) {
  return VectorFunction(TableFunction{std::move(t), std::move(value)});
}

TEST(VectorFunction, ATableIsLinearBetweenAndConstantOutside) {
  const VectorFunction f = table({1, 2, 4}, {{0, 0, 1}, {2, 0, 1}, {2, -4, 1}});
  EXPECT_EQ(f(0.0).value, (Vec3<double>{0, 0, 1}));
  EXPECT_EQ(f(1.5).value, (Vec3<double>{1, 0, 1}));
  EXPECT_EQ(f(3.0).value, (Vec3<double>{2, -2, 1}));
  EXPECT_EQ(f(9.0).value, (Vec3<double>{2, -4, 1}));
  EXPECT_EQ(f(0.5).rate, (Vec3<double>{}));
  EXPECT_EQ(f(2.0).rate, (Vec3<double>{0, -2, 0}));  // from the right
  EXPECT_EQ(f(4.0).rate, (Vec3<double>{}));
  EXPECT_EQ(f(Float128(3)).value.y, Float128(-2));
  EXPECT_THAT(f.corners(), ElementsAre(1, 2, 4));
  EXPECT_EQ(f.slope_change(0), (Vec3<double>{2, 0, 0}));
  EXPECT_EQ(f.slope_change(1), (Vec3<double>{-2, -2, 0}));
  EXPECT_EQ(f.slope_change(2), (Vec3<double>{0, 2, 0}));
  EXPECT_FALSE(f.is_smooth());
}

TEST(VectorFunction, ATableOfOneIsConstantAndSmooth) {
  const VectorFunction f = table({3}, {{1, 2, 3}});
  EXPECT_EQ(f(0.0).value, (Vec3<double>{1, 2, 3}));
  EXPECT_EQ(f(5.0).value, (Vec3<double>{1, 2, 3}));
  EXPECT_TRUE(f.corners().empty());
  EXPECT_TRUE(f.is_smooth());
}

TEST(VectorFunction, ExpressionsGiveComponents) {
  const VectorFunction f(ExpressionFunction{Expression("t"), Expression("t^2"), Expression("-1")});
  EXPECT_EQ(f(3.0).value, (Vec3<double>{3, 9, -1}));
  EXPECT_EQ(f(3.0).rate, (Vec3<double>{1, 6, 0}));
  EXPECT_TRUE(f.is_smooth());
}

std::string message(const std::vector<double>& t, const std::vector<Vec3<double>>& value) {
  try {
    table(t, value);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(VectorFunction, RefusesTablesThatAreNone) {
  EXPECT_THAT(message({}, {}), HasSubstr("found no time"));
  EXPECT_THAT(message({0, 1}, {{}}), HasSubstr("found 1 vectors, expected 2"));
  EXPECT_THAT(message({0, 1, 1}, {{}, {}, {}}), HasSubstr("t[2]: found 1, expected a finite number > 1"));
  EXPECT_THAT(message({0, std::numeric_limits<double>::quiet_NaN()}, {{}, {}}), HasSubstr("t[1]: found nan"));
}

}  // namespace
}  // namespace fw::formula
