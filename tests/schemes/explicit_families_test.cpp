#include <gtest/gtest.h>

#include <map>
#include <set>

#include "schemes/explicit_tableaus.hpp"
#include "schemes/nystrom_tableaus.hpp"
#include "schemes/order_conditions.hpp"
#include "schemes/splitting_schemes.hpp"

namespace fw::schemes {
namespace {

TEST(ExplicitTableaus, HaveTheOrdersOfTheLiterature) {
  // Order and order of the embedded solution.
  const std::map<std::string, std::pair<int, int>> orders{
      {"explicit_euler", {1, 0}}, {"midpoint", {2, 0}},    {"heun", {2, 0}},
      {"ralston2", {2, 0}},       {"heun3", {3, 0}},       {"kutta3", {3, 0}},
      {"ralston3", {3, 0}},       {"ssprk3", {3, 0}},      {"rk4", {4, 0}},
      {"three_eighths", {4, 0}},  {"ralston4", {4, 0}},    {"bogacki_shampine_32", {3, 2}},
      {"cash_karp_54", {5, 4}},   {"fehlberg_54", {5, 4}}, {"dormand_prince_54", {5, 4}},
      {"tsitouras_54", {5, 4}},   {"verner_65", {6, 5}},   {"dormand_prince_853", {8, 5}},
      {"verner_87", {8, 7}}};
  ASSERT_EQ(explicit_tableaus().size(), orders.size());
  for (const ButcherTableau& tableau : explicit_tableaus()) {
    ASSERT_TRUE(orders.contains(tableau.name)) << tableau.name;
    EXPECT_EQ(shape(tableau), TableauShape::explicit_stages) << tableau.name;
    EXPECT_EQ(order_of_accuracy(tableau), orders.at(tableau.name).first) << tableau.name;
    EXPECT_EQ(embedded_order(tableau), orders.at(tableau.name).second) << tableau.name;
    EXPECT_FALSE(tableau.title.empty() || tableau.reference.empty()) << tableau.name;
  }
}

TEST(ExplicitTableaus, HaveDenseOutputsOfOrderFourThatEndInTheSolution) {
  int count = 0;
  for (const ButcherTableau& tableau : explicit_tableaus()) {
    if (tableau.dense.empty()) continue;
    ++count;
    const TableauValues<Float128> numbers = values<Float128>(tableau);
    for (const double theta : {0.25, 0.5, 0.875, 1.0}) {
      // The method with A and b(θ)/θ on a step of θh has order 4 if and only if A/θ, b(θ)/θ meets the
      // conditions.
      TableauValues<Float128> part = numbers;
      for (Float128& a : part.a) a /= theta;
      for (std::size_t i = 0; i < part.b.size(); ++i) {
        Float128 value = 0;
        const std::vector<Float128>& polynomial = numbers.dense[i];
        for (std::size_t k = polynomial.size(); k-- > 0;) value = value * theta + polynomial[k];
        part.b[i] = value;
        if (theta == 1.0) {
          EXPECT_NEAR(static_cast<double>(value - numbers.b[i]), 0.0, 1e-28) << tableau.name;
        }
      }
      EXPECT_EQ(order_of_weights(part, part.b, 1e-26), theta == 1.0 ? 5 : 4) << tableau.name << ' ' << theta;
    }
  }
  EXPECT_EQ(count, 2);
}

TEST(ExplicitTableaus, AreCaughtWithOneWrongDigit) {
  for (const ButcherTableau& tableau : explicit_tableaus()) {
    if (tableau.stages() < 2) continue;
    const int order = order_of_accuracy(tableau);
    ButcherTableau damaged = tableau;
    damaged.A.back().back() = Coefficient(Float128(damaged.A.back().back().value() + Float128(1e-20)));
    damaged.b.back() = Coefficient(Float128(damaged.b.back().value() + Float128(1e-20)));
    EXPECT_LT(order_of_accuracy(damaged), order) << tableau.name;
  }
}

TEST(FamiliesOfExplicitSchemes, HaveDistinctNames) {
  std::set<std::string> names;
  std::size_t count = 0;
  const auto add = [&](const auto& family) {
    for (const auto& scheme : family) {
      names.insert(scheme.name);
      ++count;
    }
  };
  add(explicit_tableaus());
  add(nystrom_tableaus());
  add(splitting_schemes());
  EXPECT_EQ(names.size(), count);
  EXPECT_EQ(count, 44u);
}

TEST(SplittingSchemes, MoveByOneStepInAll) {
  for (const SplittingScheme& scheme : splitting_schemes()) {
    Float128 drift = 0, kick = 0;
    for (const Coefficient& a : scheme.drift) drift += a.value();
    for (const Coefficient& b : scheme.kick) kick += b.value();
    EXPECT_LT(static_cast<double>(abs(Float128(drift - 1))), 1e-31) << scheme.name;
    EXPECT_LT(static_cast<double>(abs(Float128(kick - 1))), 1e-31) << scheme.name;
  }
}

}  // namespace
}  // namespace fw::schemes
