#include "integrators/loop/step_size_controller.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fw::integrators {
namespace {

TEST(StepSizeController, FollowsItsFormula) {
  // k = 5: the I controller takes safety·ε^{−1/5}, and no factor leaves its limits.
  StepSizeController integral({.kind = ControllerKind::integral}, 5);
  EXPECT_NEAR(integral.after_acceptance(0.5), 0.9 * std::pow(0.5, -0.2), 1e-15);
  EXPECT_EQ(integral.after_acceptance(0.0), 5.0);
  EXPECT_NEAR(integral.after_rejection(2.0), 0.9 * std::pow(2.0, -0.2), 1e-15);
  EXPECT_EQ(integral.after_rejection(1e30), 0.2);
  EXPECT_EQ(integral.after_rejection(std::nan("")), 0.2);
  EXPECT_EQ(integral.after_acceptance(1e-5), 1.0) << "no growth after a rejection";
  EXPECT_EQ(integral.after_acceptance(1e-5), 5.0);
  StepSizeController pi({.kind = ControllerKind::proportional_integral}, 5);
  pi.after_acceptance(0.25);
  EXPECT_NEAR(pi.after_acceptance(0.5), 0.9 * std::pow(0.5, -0.14) * std::pow(0.25, 0.08), 1e-15);
}

}  // namespace
}  // namespace fw::integrators
