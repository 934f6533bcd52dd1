#include "integrators/tableau/additive_runge_kutta.hpp"

#include <gtest/gtest.h>

#include <map>

#include "core/error.hpp"
#include "implicit_problems.hpp"
#include "network.hpp"
#include "schemes/additive_tableaus.hpp"
#include "schemes/order_conditions.hpp"

namespace fw::integrators {
namespace {

/// A network end state by an explicit method with its own error far below what is measured.
Vector network_end(const Ivp& ivp) {
  return in_double(explicit_runge_kutta("dormand_prince_54")->extended_solver()(ivp, 3000));
}

TEST(AdditiveTableaus, HaveTheOrdersOfTheLiterature) {
  const std::map<std::string, std::pair<int, int>> literature = {
      {"imex_euler", {1, 0}}, {"ark324", {3, 2}}, {"ark436", {4, 3}}, {"ark548", {5, 4}}};
  for (const schemes::AdditiveTableau& tableau : schemes::additive_tableaus()) {
    ASSERT_TRUE(literature.contains(tableau.name)) << tableau.name;
    EXPECT_EQ(order_of_accuracy(tableau), literature.at(tableau.name).first) << tableau.name;
    EXPECT_EQ(embedded_order(tableau), literature.at(tableau.name).second) << tableau.name;
    for (std::size_t i = 0; i < tableau.explicit_part.A.size(); ++i) {
      const auto c = [i](const schemes::ButcherTableau& part) { return schemes::values<double>(part).c[i]; };
      EXPECT_NEAR(c(tableau.explicit_part), c(tableau.implicit_part), 1e-15) << tableau.name << " node " << i;
    }
  }
}

TEST(Additive, HasItsOrderOnANetworkOfStiffAndSoftSprings) {
  for (const bool damped : {false, true}) {
    const Ivp ivp = random_network(31, {.is_damped = damped}, 0.5);
    const Vector exact = network_end(ivp);
    for (const schemes::AdditiveTableau& tableau : schemes::additive_tableaus()) {
      const auto scheme = make_additive_runge_kutta(tableau);
      expect_order(*scheme, ivp, exact, scheme->info().order, scheme->info().order == 1 ? 160 : 24);
    }
  }
}

TEST(Additive, LosesItsOrderByOneWrongCoefficient) {
  schemes::AdditiveTableau wrong = schemes::additive_tableaus()[2];
  wrong.explicit_part.A[4][1] = "-0.35";
  EXPECT_LT(order_of_accuracy(wrong), 4);
  const Ivp ivp = random_network(31, {}, 0.5);
  const auto fit = observed_order(*make_additive_runge_kutta(wrong), ivp, network_end(ivp), 24);
  EXPECT_TRUE(!fit.valid || std::abs(fit.order - 4.0) > 0.1) << fit.order;
}

TEST(Additive, IsStableFarBeyondTheStepOfAnExplicitScheme) {
  // Two free particles, a spring of 10⁸ N/m between them and a soft one: an explicit scheme needs h < 3e-4 s.
  mechanics::MassSpringModel model;
  model.mass = {1.0, 2.0, 1.5};
  model.springs.first = {0, 1};
  model.springs.second = {1, 2};
  model.springs.stiffness = {1e8, 10.0};
  model.springs.damping = {0.0, 0.1};
  model.springs.rest_length = {1.0, 1.0};
  Ivp ivp;
  ivp.system = std::make_shared<const mechanics::MassSpringSystem>(model);
  ivp.y0 = Vector::Zero(18);
  ivp.y0[3] = 1.0;
  ivp.y0[6] = 2.2;
  ivp.t1 = 5.0;
  for (const std::string name : {"ark324", "ark436", "ark548"}) {
    const auto scheme = make_additive_runge_kutta(named(schemes::additive_tableaus(), name));
    const Solution solution = run(*scheme, ivp, 0.05);
    ASSERT_TRUE(solution.status.ok()) << name << ": " << solution.status.describe();
    EXPECT_NEAR(solution.state[3] - solution.state[0], 1.0, 1e-6) << name;
    const auto& system = dynamic_cast<const mechanics::MassSpringSystem&>(*ivp.system);
    EXPECT_LT(norm(system.linear_momentum(solution.state.tail(9))), 1e-8) << name;
  }
  EXPECT_FALSE(run(*explicit_runge_kutta("rk4"), ivp, 0.05).status.ok());
}

TEST(Additive, ChoosesItsStepsToATolerance) {
  const Ivp ivp = random_network(31, {}, 0.5);
  const Vector exact = network_end(ivp);
  for (const std::string name : {"ark324", "ark436", "ark548"}) {
    const auto scheme = make_additive_runge_kutta(named(schemes::additive_tableaus(), name));
    double previous = 0.0;
    for (const double tolerance : {1e-5, 1e-7}) {
      NullObserver observer;
      const Solution solution = scheme->solve(
          ivp, AdaptiveStep{.relative_tolerance = tolerance, .absolute_tolerance = tolerance}, observer);
      ASSERT_TRUE(solution.status.ok()) << name << ": " << solution.status.describe();
      const double error = (solution.state - exact).lpNorm<Eigen::Infinity>();
      EXPECT_LT(error, 300.0 * tolerance) << name;
      if (previous > 0.0) {
        EXPECT_LT(error, 0.05 * previous) << name;
        EXPECT_GT(error, 0.001 * previous) << name;
      }
      previous = error;
    }
  }
}

TEST(Additive, NeedsASplittingOfTheForces) {
  NullObserver observer;
  const auto scheme = make_additive_runge_kutta(schemes::additive_tableaus().front());
  EXPECT_THROW(scheme->solve(coupled_oscillators(0.0), FixedStep{.step = 0.1}, observer), InputError);
  EXPECT_THROW(scheme->solve(prothero_robinson(-1.0), FixedStep{.step = 0.1}, observer), InputError);
}

TEST(Additive, KeepsFixedPointsBitIdentical) {
  const Ivp ivp = random_network(24, {}, 0.5);
  const auto& fixed = ivp.system->second_order()->fixed();
  const Index n = ivp.y0.size() / 2;
  for (const schemes::AdditiveTableau& tableau : schemes::additive_tableaus()) {
    const Solution solution = run(*make_additive_runge_kutta(tableau), ivp, 0.5 / 64);
    ASSERT_TRUE(solution.status.ok()) << tableau.name;
    for (Index i = 0; i < n; ++i) {
      if (!fixed[static_cast<std::size_t>(i)]) continue;
      EXPECT_EQ(solution.state[i], ivp.y0[i]) << tableau.name;
      EXPECT_EQ(solution.state[n + i], 0.0) << tableau.name;
    }
  }
}

}  // namespace
}  // namespace fw::integrators
