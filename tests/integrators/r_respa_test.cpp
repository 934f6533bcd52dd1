#include "integrators/special/r_respa.hpp"

#include "core/error.hpp"
#include "order_levels.hpp"

namespace fw::integrators {
namespace {

/// A network of which every third spring is a hundred times stiffer.
Ivp two_scales(std::uint64_t seed, bool damped, double end_time) {
  const Ivp base = random_network(seed, {.is_damped = damped}, end_time);
  mechanics::MassSpringModel model = dynamic_cast<const mechanics::MassSpringSystem&>(*base.system).model();
  for (std::size_t e = 0; e < model.springs.size(); ++e)
    model.springs.stiffness[e] = e % 3 == 0 ? 4000.0 : 40.0;
  Ivp ivp = base;
  ivp.system = std::make_shared<const mechanics::MassSpringSystem>(std::move(model));
  return ivp;
}

TEST(Respa, ConvergesWithOrderTwoForBothClassesOfForces) {
  for (const int inner_steps : {1, 4}) {
    for (const bool damped : {false, true}) {
      const Ivp ivp = two_scales(81, damped, 0.21);
      expect_order(*make_r_respa({.inner_steps = inner_steps}), ivp, certified_end(ivp), 2, 60, 8,
                   damped ? "damped" : "undamped");
    }
  }
}

TEST(Respa, WithOneInnerStepIsVelocityVerletWhereForcesDependOnPositionOnly) {
  const Ivp ivp = two_scales(82, false, 0.5);
  const Vector verlet = run(*splitting("velocity_verlet"), ivp, 1.0 / 1024.0).state;
  EXPECT_LT((run(*make_r_respa({.inner_steps = 1}), ivp, 1.0 / 1024.0).state - verlet).norm(), 1e-10);
}

TEST(Respa, IsStableWhereTheStiffSpringsForbidVelocityVerlet) {
  const Ivp ivp = two_scales(83, false, 2.0);
  const double h = 0.04;
  const Solution verlet = run(*splitting("velocity_verlet"), ivp, h);
  EXPECT_TRUE(!verlet.status.ok() || verlet.state.norm() > 1e3);
  const Solution respa = run(*make_r_respa(), ivp, h);
  ASSERT_TRUE(respa.status.ok());
  EXPECT_LT(respa.state.norm(), 100.0);
}

TEST(Respa, CountsItsForces) {
  const Ivp ivp = two_scales(84, false, 1.0);
  EXPECT_EQ(run(*make_r_respa({.inner_steps = 7}), ivp, 0.01).work.rhs_evaluations, 2u + 100u * 8u);
}

TEST(Respa, RefusesSystemsThatKnowNoSplitting) {
  EXPECT_THROW(run(*make_r_respa(), driven_chain(false), 0.01), InputError);
  EXPECT_THROW(make_r_respa({.inner_steps = 0}), InputError);
}

}  // namespace
}  // namespace fw::integrators
