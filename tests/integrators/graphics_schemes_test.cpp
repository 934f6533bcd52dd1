#include "core/error.hpp"
#include "integrators/energy_momentum/discrete_gradient.hpp"
#include "integrators/graphics/projective_dynamics.hpp"
#include "integrators/graphics/xpbd.hpp"
#include "order_levels.hpp"

namespace fw::integrators {
namespace {

using mechanics::MassSpringModel;
using mechanics::MassSpringSystem;

/// A network with anchors and an obstacle, so that every kind of force is there.
Ivp rich_network(bool damped, double end_time) {
  const Ivp base = random_network(71, {.is_damped = damped}, end_time);
  MassSpringModel model = dynamic_cast<const MassSpringSystem&>(*base.system).model();
  model.anchors.push_back(
      {.particle = 2, .rest_position = {0.1, 0.9, 0.2}, .stiffness = 40.0, .damping = damped ? 2.0 : 0.0});
  model.obstacles.push_back({.shape = mechanics::Plane{{0.0, 0.0, 0.4}, {0.0, 0.0, 1.0}},
                             .stiffness = 50.0,
                             .damping = damped ? 1.0 : 0.0});
  Ivp ivp = base;
  ivp.system = std::make_shared<const MassSpringSystem>(std::move(model));
  return ivp;
}

TEST(GraphicsSchemes, ConvergeWithOrderOneEvenWithASingleIteration) {
  for (const int iterations : {1, 10}) {
    expect_claimed_orders_of_springs(*make_projective_dynamics({.iterations = iterations}), 200, 9);
    expect_claimed_orders_of_springs(*make_xpbd({.substeps = 2, .iterations = iterations}), 100, 9);
  }
}

TEST(GraphicsSchemes, ConvergeToTheSolutionWithEveryKindOfForce) {
  for (const bool damped : {false, true}) {
    const Ivp ivp = rich_network(damped, 0.3);
    const Vector reference = run(*make_discrete_gradient(), ivp, 0.3 / 4096).state;
    for (const auto& scheme : {make_projective_dynamics(), make_xpbd()}) {
      const double coarse = (run(*scheme, ivp, 0.3 / 512).state - reference).norm();
      const double fine = (run(*scheme, ivp, 0.3 / 2048).state - reference).norm();
      EXPECT_LT(fine, 0.02) << scheme->info().name;
      EXPECT_LT(fine, 0.45 * coarse) << scheme->info().name << damped;
    }
  }
}

TEST(ProjectiveDynamics, ConvergesToImplicitEulerWithItsIterations) {
  for (const auto law :
       {mechanics::SpringLaw::hooke, mechanics::SpringLaw::strain, mechanics::SpringLaw::tension_only}) {
    const Ivp ivp = random_network(72, {.law = law, .is_damped = false}, 0.2);
    const double h = 0.02;
    const Vector implicit_euler = run(*make_implicit_euler(), ivp, h).state;
    const auto distance = [&](int iterations) {
      const Solution solution = run(*make_projective_dynamics({.iterations = iterations}), ivp, h);
      EXPECT_TRUE(solution.status.ok()) << solution.status.describe();
      return (solution.state - implicit_euler).norm();
    };
    EXPECT_LT(distance(2000), 1e-8) << static_cast<int>(law);
    EXPECT_GT(distance(2), 1e-4) << static_cast<int>(law);  // not converged, as in graphics
    EXPECT_LT(distance(50), 0.5 * distance(2)) << static_cast<int>(law);
  }
}

TEST(ProjectiveDynamics, FactorisesOncePerStepLength) {
  const Ivp ivp = random_network(73, {}, 1.0);
  EXPECT_EQ(run(*make_projective_dynamics(), ivp, 0.01).work.factorisations, 1u);
  EXPECT_EQ(run(*make_projective_dynamics(), ivp, 0.03).work.factorisations, 2u);  // a shorter last step
  EXPECT_EQ(run(*make_projective_dynamics({.iterations = 7}), ivp, 0.01).work.linear_solves, 100u * 7u * 3u);
}

TEST(Xpbd, WithManySweepsIsImplicitEulerOfTheSubsteps) {
  const Ivp ivp = random_network(74, {.is_damped = false}, 0.2);
  const Vector implicit_euler = run(*make_implicit_euler(), ivp, 0.005).state;
  const auto distance = [&](int iterations) {
    return (run(*make_xpbd({.substeps = 4, .iterations = iterations}), ivp, 0.02).state - implicit_euler)
        .norm();
  };
  // Multipliers stay in the direction of each sweep, so that the limit differs from implicit Euler by O(τ²)
  // only.
  EXPECT_LT(distance(200), 0.05);
  EXPECT_LT(distance(200), distance(1));
}

TEST(Xpbd, StaysBoundedWhereASpringIsExtremelyStiff) {
  MassSpringModel model;
  model.mass = {1.0, 2.0};
  model.fixed = {0};
  model.gravity = {0.0, 0.0, -9.81};
  model.springs = {.first = {0}, .second = {1}, .stiffness = {1e12}, .damping = {0.0}, .rest_length = {1.0}};
  Ivp ivp;
  ivp.y0 = Vector::Zero(12);
  ivp.y0[3] = 1.0;
  ivp.t1 = 5.0;
  ivp.system = std::make_shared<const MassSpringSystem>(std::move(model));
  for (const auto& scheme : {make_xpbd(), make_projective_dynamics()}) {
    TrajectoryRecorder recorder;
    ASSERT_TRUE(scheme->solve(ivp, FixedStep{.step = 0.01}, recorder).status.ok()) << scheme->info().name;
    for (const Vector& y : recorder.states()) {
      EXPECT_NEAR(y.segment(3, 3).norm(), 1.0, scheme->info().name == "xpbd" ? 1e-3 : 0.1)
          << scheme->info().name;
    }
  }
}

TEST(Xpbd, HasTheExactStaticStretchOfASpring) {
  // With compliance the equilibrium does not depend on sweeps or steps: x = l₀ + m g/k.
  MassSpringModel model;
  model.mass = {1.0, 2.0};
  model.fixed = {0};
  model.gravity = {0.0, 0.0, -9.81};
  model.springs = {
      .first = {0}, .second = {1}, .stiffness = {500.0}, .damping = {30.0}, .rest_length = {1.0}};
  Ivp ivp;
  ivp.y0 = Vector::Zero(12);
  ivp.y0[5] = -1.0;
  ivp.t1 = 20.0;
  ivp.system = std::make_shared<const MassSpringSystem>(std::move(model));
  for (const int iterations : {1, 5}) {
    const Solution solution = run(*make_xpbd({.iterations = iterations}), ivp, 0.02);
    EXPECT_NEAR(solution.state[5], -1.0 - 2.0 * 9.81 / 500.0, 1e-9) << iterations;
  }
}

TEST(GraphicsSchemes, RefuseSystemsWithoutSprings) {
  EXPECT_THROW(run(*make_xpbd(), driven_chain(false), 0.01), InputError);
  EXPECT_THROW(run(*make_projective_dynamics(), driven_chain(false), 0.01), InputError);
  EXPECT_THROW(make_xpbd({.substeps = 0}), InputError);
  EXPECT_THROW(make_projective_dynamics({.iterations = 0}), InputError);
}

}  // namespace
}  // namespace fw::integrators
