#include "integrators/tableau/nystrom.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "network.hpp"
#include "order_measurement.hpp"
#include "schemes/order_conditions.hpp"

namespace fw::integrators {
namespace {

using schemes::NystromTableau;

TEST(NystromMethods, HaveTheOrderThatTheyClaim) {
  const Ivp undamped = driven_pair(0.0), damped = driven_pair(0.375);
  const std::vector<Float128> undamped_end = extrapolated_end(undamped),
                              damped_end = extrapolated_end(damped);
  for (const NystromTableau& tableau : schemes::nystrom_tableaus()) {
    const auto integrator = make_nystrom(tableau);
    expect_order(*integrator, undamped, undamped_end, integrator->info().order);
    if (integrator->info().needs.has(Capability::position_forces)) {
      EXPECT_EQ(integrator->info().order_with_velocity_forces, 0) << tableau.name;
    } else {
      expect_order(*integrator, damped, damped_end, integrator->info().order_with_velocity_forces);
    }
  }
}

TEST(NystromMethods, ClaimTheOrdersOfTheLiterature) {
  EXPECT_EQ(nystrom("nystrom4")->info().order, 4);
  EXPECT_EQ(nystrom("nystrom4_general")->info().order_with_velocity_forces, 4);
  EXPECT_EQ(nystrom("nystrom5")->info().order, 5);
  EXPECT_EQ(nystrom("dormand_prince_rkn_64")->info().order, 6);
  EXPECT_EQ(nystrom("dormand_prince_rkn_64")->info().embedded_order, 4);
  EXPECT_EQ(nystrom("dormand_prince_rkn_86")->info().order, 8);
  EXPECT_EQ(nystrom("dormand_prince_rkn_86")->info().embedded_order, 6);
}

TEST(NystromMethods, TheirEmbeddedSolutionsHaveTheOrderThatTheyClaim) {
  const Ivp ivp = driven_pair(0.0);
  const std::vector<Float128> reference = extrapolated_end(ivp);
  for (const char* name : {"dormand_prince_rkn_64", "dormand_prince_rkn_86"}) {
    NystromTableau embedded = named(schemes::nystrom_tableaus(), name);
    const int claimed = schemes::embedded_order(embedded);
    embedded.b_position = embedded.b_position_embedded;
    embedded.b_velocity = embedded.b_velocity_embedded;
    embedded.b_position_embedded.clear();
    embedded.b_velocity_embedded.clear();
    expect_order(*make_nystrom(embedded), ivp, reference, claimed);
  }
}

TEST(NystromMethods, AreCaughtWithAWrongCoefficient) {
  NystromTableau damaged = named(schemes::nystrom_tableaus(), "nystrom4");
  damaged.b_position = {"1/6", "1/6", "1/6"};
  EXPECT_LT(schemes::order_of_accuracy(damaged, false), 4);
  NystromTableau implicit = named(schemes::nystrom_tableaus(), "nystrom4");
  implicit.A_position[1] = {"1/16", "1/16"};
  EXPECT_THROW(make_nystrom(implicit), std::logic_error);
}

TEST(NystromMethods, AgreeInDoubleAndInBinary128) {
  for (const NystromTableau& tableau : schemes::nystrom_tableaus()) {
    const auto integrator = make_nystrom(tableau);
    const Ivp ivp = driven_pair(integrator->info().needs.has(Capability::position_forces) ? 0.0 : 0.375);
    const Solution solution = run(*integrator, ivp, ivp.t1 / 40.0);
    const std::vector<Float128> extended = integrator->extended_solver()(ivp, 40);
    for (Index k = 0; k < 4; ++k) {
      EXPECT_NEAR(solution.state[k], static_cast<double>(extended[static_cast<std::size_t>(k)]), 1e-13)
          << tableau.name;
    }
  }
}

TEST(NystromMethods, CountTheirForces) {
  const Ivp ivp = random_network(32, {.is_damped = false}, 1.0);
  const auto forces = [&](const char* name) { return run(*nystrom(name), ivp, 0.01).work.rhs_evaluations; };
  EXPECT_EQ(forces("nystrom4"), 300u);
  EXPECT_EQ(forces("nystrom4_general"), 400u);
  EXPECT_EQ(forces("nystrom5"), 400u);
  EXPECT_EQ(forces("dormand_prince_rkn_64"), 501u);  // the last stage is the first of the next step
  EXPECT_EQ(forces("dormand_prince_rkn_86"), 801u);
}

TEST(NystromMethods, KeepFixedParticlesStill) {
  const Ivp ivp = random_network(33, {.is_damped = false}, 1.0);
  const auto& fixed = ivp.system->second_order()->fixed();
  const auto n = static_cast<Index>(fixed.size());
  for (const NystromTableau& tableau : schemes::nystrom_tableaus()) {
    const Solution solution = run(*make_nystrom(tableau), ivp, 1.0 / 64.0);
    ASSERT_TRUE(solution.status.ok());
    for (Index i = 0; i < n; ++i) {
      if (fixed[static_cast<std::size_t>(i)] == 0) continue;
      EXPECT_EQ(solution.state[i], ivp.y0[i]) << tableau.name;
      EXPECT_EQ(solution.state[n + i], 0.0) << tableau.name;
    }
  }
}

TEST(NystromMethods, KeepTheSharedForceOfARepeatedRunOutOfTheNextOne) {
  // Two runs of one integrator are independent: all state lives in the run.
  const Ivp ivp = driven_pair(0.0);
  const auto integrator = nystrom("dormand_prince_rkn_64");
  EXPECT_EQ(run(*integrator, ivp, 0.125).state, run(*integrator, ivp, 0.125).state);
}

TEST(NystromMethods, RefuseDampersWhereTheyAreForPositionForcesOnly) {
  NullObserver observer;
  const Ivp ivp = random_network(34, {}, 1.0);
  EXPECT_THROW(nystrom("nystrom4")->solve(ivp, FixedStep{.step = 0.01}, observer), InputError);
  EXPECT_NO_THROW(nystrom("nystrom4_general")->solve(ivp, FixedStep{.step = 0.01}, observer));
}

TEST(NystromPairs, FollowTheirTolerances) {
  const Ivp ivp = driven_pair(0.0);
  const std::vector<Float128> reference = extrapolated_end(ivp);
  for (const char* name : {"dormand_prince_rkn_64", "dormand_prince_rkn_86"}) {
    const auto integrator = nystrom(name);
    double previous = 1.0;
    for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
      NullObserver observer;
      const Solution solution = integrator->solve(
          ivp, AdaptiveStep{.relative_tolerance = tolerance, .absolute_tolerance = tolerance}, observer);
      ASSERT_TRUE(solution.status.ok()) << solution.status.describe();
      double error = 0.0;
      for (Index k = 0; k < 4; ++k) {
        error = std::max(
            error, std::abs(solution.state[k] - static_cast<double>(reference[static_cast<std::size_t>(k)])));
      }
      EXPECT_LT(error, 10.0 * tolerance) << name;
      EXPECT_LT(error, previous) << name;
      previous = error;
      // One force per stage of every attempt, the first one spared after the first attempt, two of the
      // initial step.
      const auto attempts = solution.work.accepted_steps + solution.work.rejected_steps;
      const auto stages = static_cast<std::uint64_t>(integrator->info().stages);
      EXPECT_GE(solution.work.rhs_evaluations, attempts * stages + 1) << name;
      EXPECT_LE(solution.work.rhs_evaluations, attempts * stages + 3) << name;
    }
  }
}

}  // namespace
}  // namespace fw::integrators
