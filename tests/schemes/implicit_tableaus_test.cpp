#include "schemes/implicit_tableaus.hpp"

#include <gtest/gtest.h>

#include <map>

#include "schemes/order_conditions.hpp"

namespace fw::schemes {
namespace {

struct Orders {
  int order, embedded, stage_order;
};

/// What the literature says of them; the order conditions say it again.
const std::map<std::string, Orders> literature = {
    {"implicit_euler", {1, 0, 1}}, {"implicit_midpoint", {2, 0, 1}},
    {"trapezoidal", {2, 0, 2}},    {"crouzeix3", {3, 0, 1}},
    {"sdirk2", {2, 0, 1}},         {"sdirk3", {3, 0, 1}},
    {"sdirk4", {4, 3, 1}},         {"tr_bdf2", {2, 3, 2}},
    {"esdirk3", {3, 2, 2}},        {"esdirk4", {4, 3, 2}},
    {"esdirk5", {5, 4, 2}},        {"gauss2", {4, 0, 2}},
    {"gauss3", {6, 0, 3}},         {"radau_ia2", {3, 0, 1}},
    {"radau_iia2", {3, 0, 2}},     {"radau_iia3", {5, 0, 3}},
    {"lobatto_iiia3", {4, 0, 3}},  {"lobatto_iiia4", {6, 0, 4}},
    {"lobatto_iiib3", {4, 0, 1}},  {"lobatto_iiic2", {2, 0, 1}},
    {"lobatto_iiic3", {4, 0, 2}},
};

void expect_orders(const std::vector<ButcherTableau>& list) {
  for (const ButcherTableau& tableau : list) {
    ASSERT_TRUE(literature.contains(tableau.name)) << tableau.name;
    const Orders& expected = literature.at(tableau.name);
    EXPECT_EQ(order_of_accuracy(tableau), expected.order) << tableau.name;
    EXPECT_EQ(embedded_order(tableau), expected.embedded) << tableau.name;
    EXPECT_EQ(stage_order(tableau), expected.stage_order) << tableau.name;
    EXPECT_NE(shape(tableau), TableauShape::explicit_stages) << tableau.name;
  }
}

TEST(ImplicitTableaus, HaveTheOrdersOfTheLiterature) {
  expect_orders(diagonally_implicit_tableaus());
  expect_orders(fully_implicit_tableaus());
  EXPECT_EQ(diagonally_implicit_tableaus().size() + fully_implicit_tableaus().size(), literature.size());
}

TEST(ImplicitTableaus, LoseTheirOrderByOneWrongDigit) {
  ButcherTableau wrong = esdirk5();
  wrong.A[5][2] = quotient("638256894669/5436446318841");
  EXPECT_LT(order_of_accuracy(wrong), 5);
}

}  // namespace
}  // namespace fw::schemes
