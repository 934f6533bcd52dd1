#include "ode/capabilities.hpp"

#include <gtest/gtest.h>

#include "changing_network.hpp"
#include "ode/integrator.hpp"

namespace fw {
namespace {

TEST(Capabilities, AreASet) {
  Capabilities needs{Capability::second_order, Capability::springs};
  EXPECT_TRUE(needs.has(Capability::springs));
  EXPECT_FALSE(needs.has(Capability::force_splitting));
  needs.add(Capability::force_splitting);
  EXPECT_EQ(needs,
            (Capabilities{Capability::force_splitting, Capability::springs, Capability::second_order}));
  EXPECT_NE(needs, Capabilities{});
}

TEST(Capabilities, EachHasOneEntryInTheList) {
  for (const CapabilityInfo& info : capabilities()) {
    const auto position = static_cast<std::size_t>(&info - capabilities().data());
    EXPECT_EQ(static_cast<std::size_t>(info.capability), position) << info.name;
    EXPECT_FALSE(info.works_on.empty());
    EXPECT_NE(info.lacking.find("the method needs"), std::string::npos) << info.name;
  }
  EXPECT_EQ(capabilities().size(), 4u);
}

TEST(Capabilities, LackingAreNamedTheMostGeneralFirst) {
  const ChangingNetwork network(6, PatternKind::sparse);
  const ChangingNetwork of_first_order(6, PatternKind::sparse, false);
  const Capabilities all{Capability::second_order, Capability::position_forces, Capability::springs,
                         Capability::force_splitting};
  EXPECT_EQ(why_lacking({}, of_first_order), "");
  EXPECT_NE(why_lacking(all, of_first_order).find("M q'' = f(t, q, q')"), std::string::npos);
  EXPECT_NE(why_lacking(all, network).find("depend on velocity"), std::string::npos);
  EXPECT_NE(why_lacking({Capability::springs}, network).find("mass-spring"), std::string::npos);
  EXPECT_NE(why_lacking({Capability::springs}, of_first_order), "");
  EXPECT_EQ(why_lacking({Capability::second_order, Capability::force_splitting}, network), "");
  EXPECT_NE(why_lacking({Capability::force_splitting}, of_first_order).find("stiff and a soft"),
            std::string::npos);
}

TEST(Capabilities, SayWhatASchemeWorksOn) {
  EXPECT_EQ(works_on({}), "y' = f(t, y)");
  EXPECT_EQ(works_on({Capability::second_order}), "M q'' = f(t, q, q')");
  EXPECT_EQ(works_on({Capability::second_order, Capability::springs}), "mass-spring systems");
}

TEST(OrderOn, IsThatOfTheForceClassOfTheSystem) {
  const MethodInfo info{.order = 4, .order_with_velocity_forces = 1};
  EXPECT_EQ(order_on(info, ChangingNetwork(6, PatternKind::sparse)), 1);
  EXPECT_EQ(order_on(info, ChangingNetwork(6, PatternKind::sparse, false)), 4);
}

}  // namespace
}  // namespace fw
