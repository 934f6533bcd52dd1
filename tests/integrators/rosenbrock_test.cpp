#include "integrators/tableau/rosenbrock.hpp"

#include <gtest/gtest.h>

#include <map>

#include "implicit_problems.hpp"
#include "network.hpp"
#include "schemes/order_conditions.hpp"
#include "schemes/rosenbrock_tableaus.hpp"

namespace fw::integrators {
namespace {

const schemes::RosenbrockTableau& find(const std::string& name) {
  for (const schemes::RosenbrockTableau& tableau : schemes::rosenbrock_tableaus()) {
    if (tableau.name == name) return tableau;
  }
  throw std::logic_error("no tableau " + name);
}

TEST(Rosenbrock, HasTheOrdersOfTheLiterature) {
  const std::map<std::string, std::pair<int, int>> literature = {
      {"rosenbrock_euler", {1, 0}}, {"ros2", {2, 1}},   {"ros3p", {3, 2}},
      {"rodas3", {3, 2}},           {"rodas4", {4, 3}}, {"rodasp", {4, 3}}};
  for (const schemes::RosenbrockTableau& tableau : schemes::rosenbrock_tableaus()) {
    ASSERT_TRUE(literature.contains(tableau.name)) << tableau.name;
    EXPECT_EQ(order_of_accuracy(tableau), literature.at(tableau.name).first) << tableau.name;
    EXPECT_EQ(embedded_order(tableau), literature.at(tableau.name).second) << tableau.name;
  }
}

TEST(Rosenbrock, HasItsOrderWithAndWithoutDampers) {
  for (const double damping : {0.0, 0.35}) {
    const Ivp ivp = coupled_oscillators(damping);
    const Vector exact = in_double(reference_end(ivp));
    for (const schemes::RosenbrockTableau& tableau : schemes::rosenbrock_tableaus()) {
      const auto scheme = make_rosenbrock(tableau);
      expect_order(*scheme, ivp, exact, scheme->info().order, scheme->info().order <= 2 ? 80 : 25);
    }
  }
}

TEST(Rosenbrock, LosesItsOrderByOneWrongCoefficient) {
  schemes::RosenbrockTableau wrong = find("rodas3");
  wrong.gamma[3][2] = "-2/3+1/50";
  const Ivp ivp = coupled_oscillators(0.35);
  const auto fit = observed_order(*make_rosenbrock(wrong), ivp, in_double(reference_end(ivp)), 40);
  EXPECT_TRUE(!fit.valid || std::abs(fit.order - 3.0) > 0.1) << fit.order;
}

TEST(Rosenbrock, AgreesWithTheFirstOrderSystemToRounding) {
  const Ivp reduced = coupled_oscillators(0.35), full = coupled_first_order(0.35);
  for (const schemes::RosenbrockTableau& tableau : schemes::rosenbrock_tableaus()) {
    const auto scheme = make_rosenbrock(tableau);
    const Vector a = run(*scheme, reduced, 0.1).state, b = run(*scheme, full, 0.1).state;
    EXPECT_LE((a - b).norm(), 2e-13 * a.norm()) << tableau.name;
  }
}

TEST(Rosenbrock, IsOneNewtonStepOfImplicitEulerInItsFirstForm) {
  // Linear problems: both solve the same system.
  Ivp ivp = linear_oscillators();
  ivp.t1 = 1.0;
  const Vector a = run(*make_rosenbrock(find("rosenbrock_euler")), ivp, 0.1).state;
  EXPECT_LE((a - run(*make_implicit_euler(), ivp, 0.1).state).norm(), 1e-13);
}

TEST(Rosenbrock, FactorisesOnceAndSolvesOncePerStage) {
  for (const schemes::RosenbrockTableau& tableau : schemes::rosenbrock_tableaus()) {
    const auto s = static_cast<std::uint64_t>(tableau.stages());
    // The force depends on time: four evaluations for its derivative.
    const Work driven = run(*make_rosenbrock(tableau), coupled_oscillators(0.35), 2.3 / 32).work;
    EXPECT_EQ(driven.factorisations, 32u) << tableau.name;
    EXPECT_EQ(driven.jacobian_evaluations, 32u) << tableau.name;
    EXPECT_EQ(driven.linear_solves, 32u * s) << tableau.name;
    EXPECT_EQ(driven.rhs_evaluations, 32u * (s + 4)) << tableau.name;
    // It does not: two tell so.
    const Work autonomous = run(*make_rosenbrock(tableau), random_network(5, {}, 0.5), 0.5 / 32).work;
    EXPECT_EQ(autonomous.rhs_evaluations, 32u * (s + 2)) << tableau.name;
  }
}

TEST(Rosenbrock, DampsStiffComponentsWhereItIsLStable) {
  Ivp ivp = prothero_robinson(-1e6);
  ivp.y0[0] = 2.0;
  for (const std::string name : {"rodas3", "rodas4", "rodasp"}) {
    const Solution solution = run(*make_rosenbrock(find(name)), ivp, 0.05);
    EXPECT_NEAR(solution.state[0], prothero_robinson_end(), 1e-6) << name;
  }
}

TEST(Rosenbrock, ChoosesItsStepsToATolerance) {
  const Ivp ivp = coupled_oscillators(0.35);
  const Vector exact = in_double(reference_end(ivp));
  for (const schemes::RosenbrockTableau& tableau : schemes::rosenbrock_tableaus()) {
    const auto scheme = make_rosenbrock(tableau);
    EXPECT_EQ(scheme->info().is_adaptive, !tableau.b_embedded.empty());
    if (tableau.b_embedded.empty()) continue;
    double previous = 1.0;
    for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
      NullObserver observer;
      const Solution solution = scheme->solve(
          ivp, AdaptiveStep{.relative_tolerance = tolerance, .absolute_tolerance = tolerance}, observer);
      ASSERT_TRUE(solution.status.ok()) << tableau.name << ": " << solution.status.describe();
      const double error = (solution.state - exact).lpNorm<Eigen::Infinity>();
      EXPECT_LT(error, 60.0 * tolerance) << tableau.name;
      if (previous < 1.0) {
        EXPECT_LT(error, 0.05 * previous) << tableau.name;
        EXPECT_GT(error, 0.001 * previous) << tableau.name;
      }
      previous = error;
    }
  }
}

}  // namespace
}  // namespace fw::integrators
