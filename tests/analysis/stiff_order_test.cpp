#include "analysis/theory/stiff_order.hpp"

#include <gtest/gtest.h>

#include "schemes/explicit_tableaus.hpp"
#include "schemes/implicit_tableaus.hpp"
#include "schemes/multistep_formulas.hpp"
#include "schemes/rosenbrock_tableaus.hpp"

namespace fw::analysis {
namespace {

template <class List>
schemes::SchemeData find(const List& list, const std::string& name) {
  for (const auto& scheme : list) {
    if (scheme.name == name) return scheme;
  }
  throw std::logic_error("no scheme " + name);
}

struct Known {
  const char* name;
  int order;
  int power_of_product;
};

// Global errors of [Hairer, Wanner 1996, IV.15, table 15.1] with z = hλ at constant λ: Gauss h^s (s even) and
// h^{s+1} (s odd), Radau IA h^s, Radau IIA z^{-1} h^{s+1}, Lobatto IIIA z^{-1} h^s (s odd) and z^{-1} h^{s+1}
// (s even), Lobatto IIIC z^{-1} h^s.
TEST(StiffOrder, IsThatOfTheTableForCollocationSchemes) {
  const auto expect = [](const auto& list, const Known& known) {
    const StiffOrder found = stiff_order(find(list, known.name), 0.01, -1e8);
    ASSERT_TRUE(found.valid) << known.name << ": " << found.reason;
    EXPECT_EQ(found.order, known.order) << known.name;
    EXPECT_EQ(found.power_of_product, known.power_of_product) << known.name;
  };
  const Known fully[] = {{"gauss2", 2, 0},        {"gauss3", 4, 0},       {"radau_ia2", 2, 0},
                         {"radau_iia2", 2, 1},    {"radau_iia3", 3, 1},   {"lobatto_iiia3", 2, 1},
                         {"lobatto_iiic2", 1, 1}, {"lobatto_iiic3", 2, 1}};
  for (const Known& known : fully) expect(schemes::fully_implicit_tableaus(), known);
  const Known diagonal[] = {{"implicit_euler", 1, 1},
                            {"implicit_midpoint", 2, 0},
                            {"trapezoidal", 2, 1},
                            {"crouzeix3", 2, 0},
                            {"sdirk4", 1, 1}};
  for (const Known& known : diagonal) expect(schemes::diagonally_implicit_tableaus(), known);
}

TEST(StiffOrder, OfRosenbrockSchemesKnowsRos3pFromRodas3) {
  const auto order = [](const std::string& name) {
    const StiffOrder found = stiff_order(find(schemes::rosenbrock_tableaus(), name), 0.01, -1e8);
    EXPECT_TRUE(found.valid) << name << ": " << found.reason;
    return found.order;
  };
  EXPECT_EQ(order("ros3p"), 2);
  EXPECT_EQ(order("rodas3"), 1);
}

TEST(StiffOrder, OfBackwardDifferencesIsTheirOwn) {
  const StiffOrder found = stiff_order(find(schemes::multistep_formulas(), "bdf3"), 0.01, -1e8);
  ASSERT_TRUE(found.valid) << found.reason;
  EXPECT_EQ(found.order, 3);
  EXPECT_EQ(found.formula(), "h^3/lambda");
}

TEST(StiffOrder, SaysWhyThereIsNone) {
  EXPECT_FALSE(stiff_order(find(schemes::explicit_tableaus(), "rk4"), 0.01, -1e8).valid);
  EXPECT_FALSE(stiff_order(find(schemes::multistep_formulas(), "adams_moulton3"), 0.01, -1e8).valid);
  const StiffOrder none = stiff_order(schemes::SchemeData{}, 0.01, -1e8);
  EXPECT_FALSE(none.valid);
  EXPECT_FALSE(none.reason.empty());
}

}  // namespace
}  // namespace fw::analysis
