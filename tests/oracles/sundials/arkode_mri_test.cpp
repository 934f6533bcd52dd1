#include "oracles/sundials/arkode_mri.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"
#include "integrators/network.hpp"
#include "oracles/sundials/arkode.hpp"

namespace fw::oracles {
namespace {

using integrators::random_network;

Vector exact_end(const Ivp& ivp) {
  const std::vector<Float128> end =
      integrators::explicit_runge_kutta("dormand_prince_54")->extended_solver()(ivp, 3000);
  Vector result(static_cast<Index>(end.size()));
  for (std::size_t i = 0; i < end.size(); ++i) result[static_cast<Index>(i)] = static_cast<double>(end[i]);
  return result;
}

TEST(ArkodeMri, HasTheOrderOfItsCouplingOnStiffAndSoftSprings) {
  for (const bool damped : {false, true}) {
    const Ivp ivp = random_network(31, {.is_damped = damped}, 0.5);
    const Vector exact = exact_end(ivp);
    for (const std::string& coupling : arkode_couplings()) {
      const auto scheme = make_arkode_mri({.coupling = coupling});
      EXPECT_EQ(scheme->info().order, coupling == "mri_gark_erk45a" ? 4 : 3);
      const auto error = [&](int steps) {
        NullObserver observer;
        const Solution solution = scheme->solve(ivp, FixedStep{.step = 0.5 / steps}, observer);
        EXPECT_TRUE(solution.status.ok()) << solution.status.describe();
        return (solution.state - exact).lpNorm<Eigen::Infinity>();
      };
      const double order = std::log2(error(16) / error(32));
      EXPECT_NEAR(order, scheme->info().order, 0.3) << coupling << " damped " << damped;
    }
  }
}

}  // namespace
}  // namespace fw::oracles
