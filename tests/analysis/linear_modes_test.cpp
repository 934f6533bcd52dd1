#include "analysis/theory/linear_modes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "problems/cloth.hpp"
#include "problems/linear_chain.hpp"

namespace fw::analysis {
namespace {

TEST(StiffestModes, AreThoseOfAllWithinAHundredth) {
  for (const double damping : {0.0, 0.02, 2.0}) {
    const Problem cloth = problems::cloth({{"count", 8.0}, {"damping", damping}});
    const OdeSystem& system = *cloth.ivp.system;
    const LinearModes all = linear_modes(system, 0.0, cloth.ivp.y0, 1000);
    const LinearModes stiffest = stiffest_modes(*system.second_order(), 0.0, cloth.ivp.y0);
    ASSERT_TRUE(all.status.ok() && stiffest.status.ok()) << stiffest.status.describe();
    EXPECT_FALSE(stiffest.is_complete);
    EXPECT_TRUE(stiffest.is_rough);
    EXPECT_NEAR(stiffest.spectral_radius, all.spectral_radius, 0.01 * all.spectral_radius) << damping;
    EXPECT_EQ(stiffest.is_undamped, damping == 0.0);
    ASSERT_EQ(stiffest.vibrations.size(), damping == 0.0 ? 1U : 2U);
    double most = 0.0;
    for (const VibrationMode& mode : all.vibrations) most = std::max(most, mode.damping);
    if (damping > 0.0) {
      EXPECT_NEAR(stiffest.vibrations[1].damping, most, 0.01 * most) << damping;
    }
  }
}

TEST(StiffestModes, OfAChainIsTheOneOfTheClosedForm) {
  const Problem chain = problems::linear_chain({{"count", 500.0}});
  const LinearModes found = stiffest_modes(*chain.ivp.system->second_order(), 0.0, chain.ivp.y0);
  const double exact = 2.0 * std::sqrt(20.0 / 0.5) * std::sin(0.5 * std::numbers::pi * 500.0 / 501.0);
  EXPECT_NEAR(found.spectral_radius, exact, 0.005 * exact);
}

}  // namespace
}  // namespace fw::analysis
