#include "integrators/tableau/diagonally_implicit_runge_kutta.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "implicit_problems.hpp"
#include "network.hpp"

namespace fw::integrators {
namespace {

const schemes::ButcherTableau& find(const std::string& name) {
  for (const schemes::ButcherTableau& tableau : schemes::diagonally_implicit_tableaus()) {
    if (tableau.name == name) return tableau;
  }
  throw std::logic_error("no tableau " + name);
}

TEST(DiagonallyImplicit, HasItsOrderWithAndWithoutDampers) {
  for (const double damping : {0.0, 0.35}) {
    const Ivp ivp = coupled_oscillators(damping);
    const Vector exact = in_double(reference_end(ivp));
    for (const schemes::ButcherTableau& tableau : schemes::diagonally_implicit_tableaus()) {
      const auto scheme = make_diagonally_implicit_runge_kutta(tableau);
      expect_order(*scheme, ivp, exact, scheme->info().order, scheme->info().order == 1 ? 60 : 25);
    }
  }
}

TEST(DiagonallyImplicit, LosesItsOrderByOneWrongCoefficient) {
  // The verifier's own test: a coefficient that no sum of weights notices.
  schemes::ButcherTableau wrong = find("sdirk4");
  wrong.A[2][1] = "-1/24";
  const Ivp ivp = coupled_oscillators(0.35);
  const auto fit =
      observed_order(*make_diagonally_implicit_runge_kutta(wrong), ivp, in_double(reference_end(ivp)), 40);
  EXPECT_TRUE(!fit.valid || std::abs(fit.order - 4.0) > 0.1) << fit.order;
}

TEST(DiagonallyImplicit, AgreesWithTheFirstOrderSystemToRounding) {
  // Half the size against the full Jacobian: the same stages.
  const Ivp reduced = coupled_oscillators(0.35), full = coupled_first_order(0.35);
  for (const schemes::ButcherTableau& tableau : schemes::diagonally_implicit_tableaus()) {
    const auto scheme = make_diagonally_implicit_runge_kutta(tableau);
    const Vector a = run(*scheme, reduced, 0.1).state, b = run(*scheme, full, 0.1).state;
    EXPECT_LE((a - b).norm(), 1e-13 * a.norm()) << tableau.name;
  }
}

TEST(DiagonallyImplicit, KeepsItsMatrixWhileTheIterationConvergesWell) {
  const Ivp ivp = coupled_oscillators(0.35);
  const auto kept = make_diagonally_implicit_runge_kutta(find("sdirk4"));
  const auto renewed = make_diagonally_implicit_runge_kutta(find("sdirk4"), {.rate_of_renewal = 0.0});
  const Solution a = run(*kept, ivp, 2.3 / 256), b = run(*renewed, ivp, 2.3 / 256);
  EXPECT_LE((a.state - b.state).norm(), 1e-13);
  EXPECT_LT(a.work.factorisations, 10u);
  EXPECT_GE(b.work.factorisations, 5u * 256u);
}

TEST(DiagonallyImplicit, CountsOneForcePerIterationAndOneAtTheEndOfAStage) {
  const Ivp ivp = coupled_oscillators(0.0);
  const Work work = run(*make_diagonally_implicit_runge_kutta(find("implicit_midpoint")), ivp, 2.3 / 64).work;
  EXPECT_EQ(work.rhs_evaluations, work.newton_iterations + 64u);
  EXPECT_EQ(work.linear_solves, work.newton_iterations);
  EXPECT_EQ(work.jacobian_evaluations, work.factorisations);
  // A stiffly accurate method with an explicit first stage evaluates it at the first step only.
  const Work esdirk = run(*make_diagonally_implicit_runge_kutta(find("esdirk4")), ivp, 2.3 / 64).work;
  EXPECT_EQ(esdirk.rhs_evaluations, esdirk.newton_iterations + 5u * 64u + 1u);
}

TEST(DiagonallyImplicit, DampsStiffComponentsWhereItIsLStable) {
  // The start is off the smooth solution by 1: R(∞) = 0 forgets it in a step or two, |R(∞)| = 1 keeps it.
  Ivp ivp = prothero_robinson(-1e6);
  ivp.y0[0] = 2.0;
  for (const std::string name :
       {"implicit_euler", "sdirk2", "sdirk3", "sdirk4", "tr_bdf2", "esdirk3", "esdirk4", "esdirk5"}) {
    const Solution solution = run(*make_diagonally_implicit_runge_kutta(find(name)), ivp, 0.1);
    EXPECT_NEAR(solution.state[0], prothero_robinson_end(), 1e-6) << name;
  }
  for (const std::string name : {"implicit_midpoint", "trapezoidal"}) {
    const Solution solution = run(*make_diagonally_implicit_runge_kutta(find(name)), ivp, 0.1);
    EXPECT_GT(std::abs(solution.state[0] - prothero_robinson_end()), 0.5) << name;
  }
}

TEST(DiagonallyImplicit, ChoosesItsStepsToATolerance) {
  for (const double damping : {0.0, 0.35}) {
    const Ivp ivp = coupled_oscillators(damping);
    const Vector exact = in_double(reference_end(ivp));
    for (const schemes::ButcherTableau& tableau : schemes::diagonally_implicit_tableaus()) {
      if (tableau.b_embedded.empty()) continue;
      const auto scheme = make_diagonally_implicit_runge_kutta(tableau);
      EXPECT_TRUE(scheme->info().is_adaptive);
      // The tolerance is that of a step, O(h^k); where the better solution is not the one that goes on, the
      // error of the run falls like a lower power of it.
      const MethodInfo& info = scheme->info();
      const double power = static_cast<double>(info.order) / (std::min(info.order, info.embedded_order) + 1);
      double previous = 1.0;
      for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
        NullObserver observer;
        const Solution solution = scheme->solve(
            ivp, AdaptiveStep{.relative_tolerance = tolerance, .absolute_tolerance = tolerance}, observer);
        ASSERT_TRUE(solution.status.ok()) << tableau.name << ": " << solution.status.describe();
        const double error = (solution.state - exact).lpNorm<Eigen::Infinity>();
        EXPECT_LT(error, 60.0 * std::pow(tolerance, power)) << tableau.name;
        if (previous < 1.0) {
          EXPECT_LT(error, 5.0 * std::pow(0.01, power) * previous) << tableau.name;
          EXPECT_GT(error, 0.2 * std::pow(0.01, power) * previous) << tableau.name;
        }
        previous = error;
      }
    }
  }
}

TEST(DiagonallyImplicit, TakesFewStepsWhereAStiffProblemIsSmooth) {
  const Ivp ivp = prothero_robinson(-1e6);
  NullObserver observer;
  for (const std::string name : {"sdirk4", "tr_bdf2", "esdirk3", "esdirk4", "esdirk5"}) {
    const Solution solution =
        make_diagonally_implicit_runge_kutta(find(name))
            ->solve(ivp, AdaptiveStep{.relative_tolerance = 1e-5, .absolute_tolerance = 1e-5}, observer);
    ASSERT_TRUE(solution.status.ok()) << name << solution.status.describe();
    EXPECT_NEAR(solution.state[0], prothero_robinson_end(), 1e-4) << name;
    EXPECT_LT(solution.work.accepted_steps + solution.work.rejected_steps, 300u) << name;
  }
}

/// ẏ = y², which ends at t = 1/y₀.
struct Explosion {
  template <class S>
  void operator()(const S&, std::span<const S> y, std::span<S> dydt) const {
    dydt[0] = y[0] * y[0];
  }
};

TEST(DiagonallyImplicit, ReportsAStageWithoutASolutionAsAStatus) {
  // y' = y + h y'² has no real solution for h y > 1/4, that is at the first step.
  Ivp ivp;
  ivp.system = std::make_shared<FunctorSystem<Explosion>>(1, Explosion{});
  ivp.y0 = Vector{{1.0}};
  ivp.t1 = 2.0;
  const Solution solution = run(*make_diagonally_implicit_runge_kutta(find("implicit_euler")), ivp, 0.4);
  EXPECT_FALSE(solution.status.ok());
  // The damped iteration creeps to where |g| is least, and there the matrix is singular.
  EXPECT_TRUE(solution.status.code == StatusCode::newton_failed ||
              solution.status.code == StatusCode::matrix_singular)
      << solution.status.describe();
  EXPECT_EQ(solution.time, 0.0);
  EXPECT_EQ(solution.state[0], 1.0);
  // With chosen steps the singularity at t = 1 is approached and then reported.
  NullObserver observer;
  const Solution chosen =
      make_diagonally_implicit_runge_kutta(find("sdirk4"))->solve(ivp, AdaptiveStep{}, observer);
  EXPECT_FALSE(chosen.status.ok());
  EXPECT_NEAR(chosen.time, 1.0, 1e-3) << chosen.status.describe();
}

TEST(DiagonallyImplicit, KeepsQuadraticInvariantsWhereTheCoefficientsSaySo) {
  const Ivp ivp = linear_oscillators();
  const auto change = [&](const std::string& name) {
    const Vector end = run(*make_diagonally_implicit_runge_kutta(find(name)), ivp, 0.1).state;
    return std::abs(linear_energy(end) - linear_energy(ivp.y0));
  };
  EXPECT_LT(change("implicit_midpoint"), 1e-12);
  EXPECT_LT(change("trapezoidal"), 1e-12);
  EXPECT_GT(change("sdirk2"), 1e-2);
}

TEST(DiagonallyImplicit, RefusesOtherTableaus) {
  EXPECT_THROW(make_diagonally_implicit_runge_kutta(schemes::explicit_tableaus().front()), std::logic_error);
  EXPECT_THROW(make_diagonally_implicit_runge_kutta(schemes::fully_implicit_tableaus().front()),
               std::logic_error);
}

}  // namespace
}  // namespace fw::integrators
