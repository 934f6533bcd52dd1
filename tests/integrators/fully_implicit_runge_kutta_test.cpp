#include "integrators/tableau/fully_implicit_runge_kutta.hpp"

#include <gtest/gtest.h>

#include "implicit_problems.hpp"
#include "network.hpp"
#include "problems/oscillators.hpp"

namespace fw::integrators {
namespace {

const schemes::ButcherTableau& tableau_named(const std::string& name) {
  return named(schemes::fully_implicit_tableaus(), name);
}

TEST(FullyImplicit, HasItsOrderWithAndWithoutDampers) {
  for (const double damping : {0.0, 0.35}) {
    const Ivp ivp = coupled_oscillators(damping);
    const Vector exact = in_double(reference_end(ivp));
    for (const schemes::ButcherTableau& tableau : schemes::fully_implicit_tableaus()) {
      const auto scheme = make_fully_implicit_runge_kutta(tableau);
      if (scheme->info().order > 5) continue;  // see below
      expect_order(*scheme, ivp, exact, scheme->info().order, scheme->info().order == 2 ? 40 : 12);
    }
  }
}

TEST(FullyImplicit, HasItsOrderInBinary128) {
  const Ivp ivp = coupled_oscillators(0.35);
  const std::vector<Float128> exact =
      make_fully_implicit_runge_kutta(tableau_named("gauss3"))->extended_solver()(ivp, 2000);
  for (const std::string name : {"gauss3", "lobatto_iiia4", "radau_iia3"}) {
    const auto scheme = make_fully_implicit_runge_kutta(tableau_named(name));
    std::vector<double> steps, errors;
    for (const std::uint64_t count : {24u, 32u, 42u, 56u, 75u, 100u, 133u}) {
      const std::vector<Float128> end = scheme->extended_solver()(ivp, count);
      Float128 error = 0;
      for (std::size_t k = 0; k < end.size(); ++k) error = std::max(error, Float128(abs(end[k] - exact[k])));
      steps.push_back(1.0 / static_cast<double>(count));
      errors.push_back(static_cast<double>(error));
    }
    const analysis::OrderFit fit = analysis::fit_order(steps, errors, 1e-20);
    ASSERT_TRUE(fit.valid) << name << fit.reason;
    EXPECT_NEAR(fit.order, scheme->info().order, 0.1) << name;
  }
}

TEST(FullyImplicit, TakesTheSameStepsInDoubleAndInBinary128) {
  const Ivp ivp = coupled_oscillators(0.35);
  for (const schemes::ButcherTableau& tableau : schemes::fully_implicit_tableaus()) {
    const auto scheme = make_fully_implicit_runge_kutta(tableau);
    const Vector slow = in_double(scheme->extended_solver()(ivp, 23));
    const Vector fast = run(*scheme, ivp, 0.1).state;
    EXPECT_LE((slow - fast).norm(), 1e-13 * slow.norm()) << tableau.name;
  }
  for (const schemes::ButcherTableau& tableau : schemes::diagonally_implicit_tableaus()) {
    const auto scheme = make_diagonally_implicit_runge_kutta(tableau);
    const Vector slow = in_double(scheme->extended_solver()(ivp, 23));
    EXPECT_LE((slow - run(*scheme, ivp, 0.1).state).norm(), 1e-13 * slow.norm()) << tableau.name;
  }
}

TEST(FullyImplicit, AgreesWithTheFirstOrderSystemToRounding) {
  const Ivp reduced = coupled_oscillators(0.35), full = coupled_first_order(0.35);
  for (const schemes::ButcherTableau& tableau : schemes::fully_implicit_tableaus()) {
    const auto scheme = make_fully_implicit_runge_kutta(tableau);
    const Vector a = run(*scheme, reduced, 0.1).state, b = run(*scheme, full, 0.1).state;
    EXPECT_LE((a - b).norm(), 1e-13 * a.norm()) << tableau.name;
  }
}

TEST(FullyImplicit, KeepsQuadraticInvariantsWhereTheCoefficientsSaySo) {
  Ivp ivp = linear_oscillators();
  const auto change = [&](const std::string& name) {
    const Vector end = run(*make_fully_implicit_runge_kutta(tableau_named(name)), ivp, 0.2).state;
    return std::abs(linear_energy(end) - linear_energy(ivp.y0));
  };
  // 500 steps.
  EXPECT_LT(change("gauss2"), 1e-12);
  EXPECT_LT(change("gauss3"), 1e-12);
  for (const std::string name : {"radau_iia3", "lobatto_iiic3"}) EXPECT_GT(change(name), 1e-7) << name;
  ivp.t1 = ivp.t0 + 0.2;
  EXPECT_LT(change("gauss2"), 1e-14);
  EXPECT_LT(change("gauss3"), 1e-14);
}

TEST(Gauss, KeepsTheAngularMomentumOfANonlinearNetwork) {
  const Ivp ivp = random_network(23, {.is_damped = false, .is_free = true}, 2.0);
  const auto& system = dynamic_cast<const mechanics::MassSpringSystem&>(*ivp.system);
  const Index n = ivp.y0.size() / 2;
  const auto drift = [&](const std::string& name) {
    const Vector y = run(*make_fully_implicit_runge_kutta(tableau_named(name)), ivp, 0.02).state;
    return norm(system.angular_momentum(y.head(n), y.tail(n)) -
                system.angular_momentum(ivp.y0.head(n), ivp.y0.tail(n)));
  };
  EXPECT_LT(drift("gauss2"), 1e-12);
  EXPECT_LT(drift("gauss3"), 1e-12);
  EXPECT_GT(drift("radau_iia2"), 1e-7);
}

TEST(FullyImplicit, KeepsItsMatrixWhileTheIterationConvergesWell) {
  const Ivp ivp = coupled_oscillators(0.35);
  const auto kept = make_fully_implicit_runge_kutta(tableau_named("radau_iia3"));
  const auto renewed = make_fully_implicit_runge_kutta(tableau_named("radau_iia3"), {.rate_of_renewal = 0.0});
  const Solution a = run(*kept, ivp, 2.3 / 256), b = run(*renewed, ivp, 2.3 / 256);
  EXPECT_LE((a.state - b.state).norm(), 1e-13);
  EXPECT_LT(a.work.factorisations, 10u);
  EXPECT_EQ(b.work.factorisations, 256u);
  EXPECT_EQ(a.work.rhs_evaluations, 3u * (a.work.newton_iterations + 256u));
}

TEST(FullyImplicit, DampsStiffComponentsWhereItIsLStable) {
  Ivp ivp = prothero_robinson(-1e6);
  ivp.y0[0] = 2.0;
  for (const std::string name : {"radau_ia2", "radau_iia2", "radau_iia3", "lobatto_iiic2", "lobatto_iiic3"}) {
    const Solution solution = run(*make_fully_implicit_runge_kutta(tableau_named(name)), ivp, 0.1);
    EXPECT_NEAR(solution.state[0], prothero_robinson_end(), name == "radau_ia2" ? 1e-2 : 1e-6) << name;
  }
  for (const std::string name : {"gauss2", "gauss3", "lobatto_iiia3"}) {
    const Solution solution = run(*make_fully_implicit_runge_kutta(tableau_named(name)), ivp, 0.1);
    EXPECT_GT(std::abs(solution.state[0] - prothero_robinson_end()), 0.5) << name;
  }
}

TEST(FullyImplicit, KeepsTheEnergyAtStepsFarBeyondAPeriod) {
  Problem problem = problems::harmonic_oscillator();
  const double omega = problem.stiffness();
  const auto energy = [&](const Vector& y) { return problem.invariants.front().value(0.0, y); };
  for (const std::string name : {"gauss2", "gauss3", "lobatto_iiia3", "lobatto_iiia4"}) {
    for (const double z : {1e2, 1e3, 1e4, 1e5}) {
      Ivp ivp = problem.ivp;
      const double h = z / omega;
      ivp.t1 = ivp.t0 + 3.0 * h;
      const Vector end = run(*make_fully_implicit_runge_kutta(tableau_named(name)), ivp, h).state;
      const double start = energy(ivp.y0);
      // Accelerations times h² cancel to the state: ε z².
      EXPECT_LE(std::abs(energy(end) - start), 1e-13 * z * z * start) << name << ", h omega = " << z;
    }
  }
}

TEST(FullyImplicit, ReportsStagesWithoutASolutionAsAStatus) {
  // Cubic springs at 1e120: the force overflows.
  Ivp ivp = coupled_oscillators(0.0);
  ivp.y0 = Vector{{1e120, -1e120, 0.0, 0.0}};
  const Solution solution = run(*make_fully_implicit_runge_kutta(tableau_named("gauss2")), ivp, 0.5);
  EXPECT_FALSE(solution.status.ok());
  EXPECT_EQ(solution.state, ivp.y0);
}

}  // namespace
}  // namespace fw::integrators
