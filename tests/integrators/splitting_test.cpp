#include "integrators/tableau/splitting.hpp"

#include <gtest/gtest.h>

#include <map>

#include "network.hpp"
#include "order_measurement.hpp"
#include "schemes/order_conditions.hpp"

namespace fw::integrators {
namespace {

using schemes::SplittingScheme;

TEST(SplittingSchemes, HaveTheOrderThatTheyClaimForPositionForces) {
  const Ivp ivp = driven_pair(0.0);
  const std::vector<Float128> reference = extrapolated_end(ivp);
  for (const SplittingScheme& scheme : schemes::splitting_schemes()) {
    const auto integrator = make_splitting(scheme);
    expect_order(*integrator, ivp, reference, integrator->info().order);
  }
}

TEST(SplittingSchemes, HaveTheOrderThatTheyClaimForVelocityForces) {
  const Ivp ivp = driven_pair(0.375);
  const std::vector<Float128> reference = extrapolated_end(ivp);
  for (const SplittingScheme& scheme : schemes::splitting_schemes()) {
    const auto integrator = make_splitting(scheme);
    expect_order(*integrator, ivp, reference, integrator->info().order_with_velocity_forces);
  }
}

TEST(SplittingSchemes, ClaimTheOrdersOfTheLiterature) {
  // Order for position forces and for velocity forces; schemes of Nyström type lose there.
  const std::map<std::string, std::pair<int, int>> orders{{"symplectic_euler", {1, 1}},
                                                          {"symplectic_euler_b", {1, 1}},
                                                          {"velocity_verlet", {2, 2}},
                                                          {"position_verlet", {2, 2}},
                                                          {"mclachlan_atela_2", {2, 2}},
                                                          {"ruth3", {3, 3}},
                                                          {"mclachlan_atela_3", {3, 3}},
                                                          {"mclachlan_atela_4", {4, 3}},
                                                          {"forest_ruth", {4, 4}},
                                                          {"suzuki4", {4, 4}},
                                                          {"pefrl", {4, 4}},
                                                          {"mclachlan4", {4, 4}},
                                                          {"blanes_moan4", {4, 4}},
                                                          {"blanes_moan_rkn4", {4, 4}},
                                                          {"yoshida6", {6, 6}},
                                                          {"kahan_li6", {6, 6}},
                                                          {"blanes_moan6", {6, 6}},
                                                          {"blanes_moan_rkn6", {6, 4}},
                                                          {"yoshida8", {8, 8}},
                                                          {"kahan_li8", {8, 8}}};
  ASSERT_EQ(schemes::splitting_schemes().size(), orders.size());
  for (const auto& [name, order] : orders) {
    EXPECT_EQ(splitting(name)->info().order, order.first) << name;
    EXPECT_EQ(splitting(name)->info().order_with_velocity_forces, order.second) << name;
    EXPECT_TRUE(splitting(name)->info().is_symplectic) << name;
  }
}

TEST(SplittingSchemes, FallToOrderOneWithoutTheirImplicitKicks) {
  // Negative control: position Verlet with its kick at the velocity before it.
  const Ivp ivp = driven_pair(0.375);
  const std::vector<Float128> reference = extrapolated_end(ivp);
  std::vector<double> steps, errors;
  for (const double n : {400.0, 600.0, 800.0, 1200.0, 1600.0, 2400.0}) {
    const Float128 h = Float128(ivp.t1) / n;
    std::vector<Float128> y{0.5, -0.25, 0.25, 0.75}, slope(4);
    for (int i = 0; i < static_cast<int>(n); ++i) {
      for (std::size_t k = 0; k < 2; ++k) y[k] += h / 2 * y[k + 2];
      ivp.system->rhs(Float128((i + Float128(0.5)) * h), y, slope);
      for (std::size_t k = 0; k < 2; ++k) y[k + 2] += h * slope[k + 2];
      for (std::size_t k = 0; k < 2; ++k) y[k] += h / 2 * y[k + 2];
    }
    steps.push_back(static_cast<double>(h));
    errors.push_back(distance(y, reference));
  }
  EXPECT_NEAR(analysis::fit_order(steps, errors, 0.0).order, 1.0, 0.1);
}

TEST(SplittingSchemes, AreCaughtWithASwappedCoefficient) {
  SplittingScheme damaged = named(schemes::splitting_schemes(), "ruth3");
  std::swap(damaged.kick[0], damaged.kick[1]);
  EXPECT_EQ(schemes::order_of_accuracy(damaged, false), 1);
  SplittingScheme rounded = named(schemes::splitting_schemes(), "yoshida8");
  rounded.kick[3] = "-0.158240635368243";  // as printed
  EXPECT_LT(schemes::order_of_accuracy(rounded, false), 8);
}

TEST(SplittingSchemes, AgreeInDoubleAndInBinary128) {
  for (const double damping : {0.0, 0.375}) {
    const Ivp ivp = driven_pair(damping);
    for (const SplittingScheme& scheme : schemes::splitting_schemes()) {
      const auto integrator = make_splitting(scheme);
      const Solution solution = run(*integrator, ivp, ivp.t1 / 40.0);
      ASSERT_TRUE(solution.status.ok()) << scheme.name << ": " << solution.status.describe();
      const std::vector<Float128> extended = integrator->extended_solver()(ivp, 40);
      for (Index k = 0; k < 4; ++k) {
        EXPECT_NEAR(solution.state[k], static_cast<double>(extended[static_cast<std::size_t>(k)]), 2e-13)
            << scheme.name << " damping " << damping;
      }
    }
  }
}

TEST(SplittingSchemes, CostOneForcePerKickAndShareTheOneBetweenSteps) {
  const Ivp ivp = random_network(31, {.is_damped = false}, 1.0);
  const std::map<std::string, unsigned> forces{{"symplectic_euler", 100},
                                               {"symplectic_euler_b", 100},
                                               {"velocity_verlet", 101},
                                               {"position_verlet", 100},
                                               {"ruth3", 300},
                                               {"forest_ruth", 300},
                                               {"pefrl", 400},
                                               {"blanes_moan4", 600},
                                               {"blanes_moan_rkn4", 601},
                                               {"blanes_moan_rkn6", 1101},
                                               {"kahan_li8", 1700}};
  for (const auto& [name, count] : forces) {
    const auto integrator = splitting(name);
    EXPECT_EQ(run(*integrator, ivp, 0.01).work.rhs_evaluations, count) << name;
    EXPECT_EQ(static_cast<unsigned>(integrator->info().stages), count / 100) << name;
  }
}

TEST(SplittingSchemes, KeepTheSharedForceAcrossAShorterLastStep) {
  Ivp ivp = driven_pair(0.0);
  const auto scheme = splitting("velocity_verlet");
  const Solution whole = run(*scheme, ivp, 0.25);  // 5 steps and a half
  ivp.t1 = 1.25;
  const Solution first = run(*scheme, ivp, 0.25);
  ivp.t0 = 1.25;
  ivp.t1 = 1.375;
  ivp.y0 = first.state;
  EXPECT_EQ(run(*scheme, ivp, 0.125).state, whole.state);
}

TEST(SymmetricCompositions, RepeatPositionVerletWithTheirWeights) {
  const SplittingScheme scheme = schemes::from_symmetric_weights({.name = "half_steps"}, {"1/4"});
  ASSERT_EQ(scheme.kick.size(), 3u);  // 1/4, 1/2, 1/4
  const Ivp ivp = driven_pair(0.375);
  Ivp part = ivp;
  for (const double end : {0.25, 0.75, 1.0}) {
    part.t1 = end * ivp.t1;
    part.y0 = run(*splitting("position_verlet"), part, part.t1 - part.t0).state;
    part.t0 = part.t1;
  }
  EXPECT_LT((run(*make_splitting(scheme), ivp, ivp.t1).state - part.y0).norm(), 1e-14);
}

}  // namespace
}  // namespace fw::integrators
