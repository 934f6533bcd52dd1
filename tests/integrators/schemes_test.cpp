#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "network.hpp"
#include "ode/functor_system.hpp"
#include "problems/oscillators.hpp"
#include "schemes/derived_properties.hpp"

namespace fw::integrators {
namespace {

/// q̈ = t² and v(0), q(0) given: the solution is a polynomial of degree 4 in t.
struct QuadraticForce {
  template <class S>
  void operator()(const S& t, std::span<const S>, std::span<const S>, std::span<S> f) const {
    f[0] = S(3) * (S(2) - t);  // m = 3
  }
};

/// ẏ = 4t³: RK4 is exact.
struct CubicSlope {
  template <class S>
  void operator()(const S& t, std::span<const S>, std::span<S> dydt) const {
    dydt[0] = S(4) * t * t * t;
  }
};

/// A constant force on a mass of 3 kg.
struct ConstantForce {
  template <class S>
  void operator()(const S&, std::span<const S>, std::span<const S>, std::span<S> f) const {
    f[0] = S(-6);
  }
};

Ivp falling_mass() {
  Ivp ivp;
  ivp.system = std::make_shared<FunctorSecondOrderSystem<ConstantForce>>(Vector{{3.0}}, ForceClass::position,
                                                                         ConstantForce{});
  ivp.y0 = Vector{{1.5, 4.0}};
  ivp.t1 = 2.0;
  return ivp;
}

TEST(Rk4, IntegratesCubicsExactly) {
  Ivp ivp;
  ivp.system = std::make_shared<FunctorSystem<CubicSlope>>(1, CubicSlope{});
  ivp.y0 = Vector{{0.25}};
  ivp.t1 = 1.0;
  const Solution solution = run(*explicit_runge_kutta("rk4"), ivp, 1.0);
  EXPECT_NEAR(solution.state[0], 1.25, 1e-15);
  EXPECT_EQ(solution.work.rhs_evaluations, 4u);
}

TEST(VerletSchemes, FollowAParabolaExactly) {
  for (const auto& scheme : {make_verlet(VerletVelocity::central), splitting("velocity_verlet")}) {
    const Solution solution = run(*scheme, falling_mass(), 0.125);
    ASSERT_TRUE(solution.status.ok());
    EXPECT_NEAR(solution.state[0], 1.5 + 4.0 * 2.0 - 2.0 * 2.0, 1e-13) << scheme->info().name;
    EXPECT_NEAR(solution.state[1], 4.0 - 2.0 * 2.0, 1e-13) << scheme->info().name;
  }
}

TEST(SymplecticEuler, UsesTheNewVelocityAndExplicitEulerTheOldOne) {
  Ivp ivp = falling_mass();
  ivp.t1 = 0.5;  // one step: v' = 4 − 2·½ = 3
  EXPECT_DOUBLE_EQ(run(*splitting("symplectic_euler"), ivp, 0.5).state[0], 1.5 + 0.5 * 3.0);
  EXPECT_DOUBLE_EQ(run(*explicit_runge_kutta("explicit_euler"), ivp, 0.5).state[0], 1.5 + 0.5 * 4.0);
}

TEST(Schemes, EvaluateTheForceAtTheRightTime) {
  Ivp ivp;
  ivp.system = std::make_shared<FunctorSecondOrderSystem<QuadraticForce>>(Vector{{3.0}}, ForceClass::position,
                                                                          QuadraticForce{});
  ivp.y0 = Vector{{0.0, 1.0}};
  ivp.t1 = 1.0;
  // q̈ = 2 − t: q(1) = 1 + 1 − 1/6, v(1) = 1 + 2 − 1/2.
  for (const auto& scheme : all_schemes()) {
    const double h = 1.0 / 2048.0;
    const Solution solution = run(*scheme, ivp, h);
    ASSERT_TRUE(solution.status.ok()) << scheme->info().name << ": " << solution.status.describe();
    const double tolerance = scheme->info().order == 1 ? 3.0 * h : 3.0 * h * h;
    EXPECT_NEAR(solution.state[0], 11.0 / 6.0, tolerance) << scheme->info().name;
    EXPECT_NEAR(solution.state[1], 2.5, tolerance) << scheme->info().name;
  }
}

TEST(Verlet, HasThePositionsOfVelocityVerletWhereForcesDependOnPositionOnly) {
  const Ivp ivp = random_network(11, {.is_damped = false}, 1.0);
  const Index n = ivp.y0.size() / 2;
  const Solution two_step = run(*make_verlet(VerletVelocity::central), ivp, 1.0 / 512.0);
  const Solution one_step = run(*splitting("velocity_verlet"), ivp, 1.0 / 512.0);
  EXPECT_LT((two_step.state.head(n) - one_step.state.head(n)).norm(), 1e-11);
  EXPECT_LT((two_step.state.tail(n) - one_step.state.tail(n)).norm(), 1e-9);
}

TEST(VelocityVerlet, ConservesItsModifiedEnergyOnALinearSpringToRounding) {
  // v²/2 + ω²(1 − h²ω²/4) x²/2 is an exact invariant of the scheme.
  const Problem problem = problems::harmonic_oscillator({{"mass", 2.0}, {"stiffness", 8.0}});
  Ivp ivp = problem.ivp;
  const double omega2 = 4.0, h = 0.3;
  ivp.t1 = 3000.0;
  const auto modified_energy = [&](const Vector& y) {
    return 0.5 * y[1] * y[1] + 0.5 * omega2 * (1.0 - h * h * omega2 / 4.0) * y[0] * y[0];
  };
  TrajectoryRecorder recorder;
  const Solution solution = splitting("velocity_verlet")->solve(ivp, FixedStep{.step = h}, recorder);
  ASSERT_TRUE(solution.status.ok());
  const double start = modified_energy(recorder.states().front());
  double largest = 0.0, largest_energy_error = 0.0;
  for (const Vector& y : recorder.states()) {
    largest = std::max(largest, std::abs(modified_energy(y) - start));
    const double energy = 0.5 * y[1] * y[1] + 0.5 * omega2 * y[0] * y[0];
    largest_energy_error = std::max(largest_energy_error, std::abs(energy - start));
  }
  EXPECT_LT(largest, 1e-12 * start);
  EXPECT_GT(largest_energy_error, 1e-3 * start);  // negative control: the true energy oscillates
}

TEST(SymplecticEuler, ConservesItsModifiedEnergyOnALinearSpringToRounding) {
  // v²/2 + ω²x²/2 − hω²xv/2 for the variant that kicks first.
  const Problem problem = problems::harmonic_oscillator({{"mass", 2.0}, {"stiffness", 8.0}});
  Ivp ivp = problem.ivp;
  const double omega2 = 4.0, h = 0.3;
  ivp.t1 = 3000.0;
  const auto modified_energy = [&](const Vector& y, double sign) {
    return 0.5 * y[1] * y[1] + 0.5 * omega2 * y[0] * y[0] + sign * 0.5 * h * omega2 * y[0] * y[1];
  };
  TrajectoryRecorder recorder;
  ASSERT_TRUE(splitting("symplectic_euler")->solve(ivp, FixedStep{.step = h}, recorder).status.ok());
  double kick_first = 0.0, drift_first = 0.0;
  for (const Vector& y : recorder.states()) {
    kick_first = std::max(kick_first,
                          std::abs(modified_energy(y, -1.0) - modified_energy(recorder.states()[0], -1.0)));
    drift_first =
        std::max(drift_first, std::abs(modified_energy(y, 1.0) - modified_energy(recorder.states()[0], 1.0)));
  }
  EXPECT_LT(kick_first, 1e-12);
  EXPECT_GT(drift_first, 1e-2);  // negative control: the other sign belongs to the other variant
}

TEST(ExplicitEuler, GrowsOnTheCircleByTheFactorOfTheLecture) {
  const Problem problem = problems::harmonic_oscillator({{"mass", 1.0}, {"stiffness", 1.0}});
  Ivp ivp = problem.ivp;
  const double h = 0.01;
  ivp.t1 = 10.0;
  const Solution solution = run(*explicit_runge_kutta("explicit_euler"), ivp, h);
  EXPECT_NEAR(solution.state.norm() / ivp.y0.norm(), std::pow(1.0 + h * h, 500.0), 1e-10);
}

TEST(ImplicitEuler, ShrinksOnTheCircleByTheInverseFactor) {
  const Problem problem = problems::harmonic_oscillator({{"mass", 1.0}, {"stiffness", 1.0}});
  Ivp ivp = problem.ivp;
  const double h = 0.1;
  ivp.t1 = 10.0;
  for (const auto& scheme : {make_implicit_euler(), make_implicit_euler_linearised({})}) {
    const Solution solution = run(*scheme, ivp, h);
    ASSERT_TRUE(solution.status.ok());
    EXPECT_NEAR(solution.state.norm() / ivp.y0.norm(), std::pow(1.0 + h * h, -50.0), 1e-10)
        << scheme->info().name;
  }
}

TEST(ImplicitEuler, SolvesItsEquationOnANonlinearNetwork) {
  const Ivp ivp = random_network(12, {}, 0.05);
  const double h = 0.05;
  const Solution solution = run(*make_implicit_euler(), ivp, h);
  ASSERT_TRUE(solution.status.ok()) << solution.status.describe();
  Vector slope(ivp.y0.size());
  ivp.system->rhs(h, solution.state, slope);
  EXPECT_LT((solution.state - ivp.y0 - h * slope).norm(), 1e-12 * solution.state.norm());
}

TEST(ImplicitEulerLinearised, IsOneNewtonStepOfImplicitEuler) {
  // Without dampers: A (v' − v) = h (f + h K v) is Newton's first correction from v' = v … x' = x.
  const Ivp ivp = random_network(13, {.is_damped = false}, 0.02);
  const double h = 0.02;
  const Index n = ivp.y0.size() / 2;
  const auto* system = ivp.system->second_order();
  SparseMatrix K = system->tangent_pattern();
  system->stiffness(0.0, ivp.y0.head(n), ivp.y0.tail(n), TangentModel::exact, K);
  Vector f(n);
  system->force(0.0, ivp.y0.head(n), ivp.y0.tail(n), f);
  const Matrix A = Matrix(system->mass().asDiagonal()) - h * h * Matrix(K);
  const Vector b = system->mass().cwiseProduct(ivp.y0.tail(n)) + h * f;  // the lecture's right-hand side
  const Vector expected = A.partialPivLu().solve(b);
  for (auto kind : {linalg::LinearSolverKind::conjugate_gradient, linalg::LinearSolverKind::sparse_cholesky,
                    linalg::LinearSolverKind::sparse_lu}) {
    const Solution solution =
        run(*make_implicit_euler_linearised({.linear_solver = {.kind = kind, .relative_tolerance = 1e-13}}),
            ivp, h);
    ASSERT_TRUE(solution.status.ok()) << solution.status.describe();
    EXPECT_LT((solution.state.tail(n) - expected).norm(), 1e-10 * expected.norm());
    EXPECT_LT((solution.state.head(n) - ivp.y0.head(n) - h * expected).norm(), 1e-12);
  }
}

TEST(ImplicitEulerLinearised, EndsWithAStatusWhereTheTangentIsIndefiniteAndGoesOnWithAProjection) {
  // A spring compressed to half its length buckles: 1 − l₀/L = −1 across.
  mechanics::MassSpringModel model;
  model.mass = {1.0, 1.0};
  model.springs = {{0}, {1}, {1000.0}, {0.0}, {2.0}, mechanics::SpringLaw::hooke};
  Ivp ivp;
  ivp.system = std::make_shared<const mechanics::MassSpringSystem>(model);
  ivp.y0 = Vector::Zero(12);
  ivp.y0[3] = 1.0;
  ivp.t1 = 0.1;
  for (auto kind :
       {linalg::LinearSolverKind::conjugate_gradient, linalg::LinearSolverKind::sparse_cholesky}) {
    LinearisedOptions options{.linear_solver = {.kind = kind}};
    const Solution exact = run(*make_implicit_euler_linearised(options), ivp, 0.1);
    EXPECT_EQ(exact.status.code, StatusCode::matrix_indefinite) << exact.status.describe();
    EXPECT_EQ(exact.time, 0.0);
    EXPECT_EQ(exact.state, ivp.y0);  // the last good state
    for (TangentModel tangent : {TangentModel::tensile_geometric_term, TangentModel::psd_projection}) {
      options.tangent = tangent;
      EXPECT_TRUE(run(*make_implicit_euler_linearised(options), ivp, 0.1).status.ok());
    }
  }
}

TEST(MultistepSchemes, RefuseABrokenIntervalAndNameTheNearestSteps) {
  const Ivp ivp = random_network(14, {}, 1.0);
  try {
    run(*make_verlet(VerletVelocity::central), ivp, 0.3);
    FAIL() << "expected an InputError";
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("0.25"), std::string::npos) << text;
    EXPECT_NE(text.find("0.3333"), std::string::npos) << text;
  }
}

TEST(OneStepSchemes, TakeAShorterLastStepThatEndsExactly) {
  const Ivp ivp = random_network(15, {}, 1.0);
  TrajectoryRecorder recorder;
  const Solution solution = splitting("velocity_verlet")->solve(ivp, FixedStep{.step = 0.03}, recorder);
  ASSERT_TRUE(solution.status.ok());
  EXPECT_EQ(recorder.times().size(), 35u);  // 33 whole steps and one of 0.01
  EXPECT_EQ(recorder.times().back(), 1.0);
  EXPECT_EQ(recorder.times()[10], 10 * 0.03);
  // The shorter step is a step of the scheme: the result still converges with order 2.
  const Solution fine = run(*splitting("velocity_verlet"), ivp, 1e-4);
  EXPECT_LT((solution.state - fine.state).norm(), 0.1);
}

TEST(Schemes, ReportAnExplosionAsAStatusWithTheLastGoodState) {
  const Problem problem = problems::harmonic_oscillator({{"mass", 1.0}, {"stiffness", 1e6}});
  Ivp ivp = problem.ivp;
  ivp.t1 = 1e4;
  for (const auto& scheme : all_schemes()) {
    if (!scheme->info().is_explicit) continue;
    const Solution solution = run(*scheme, ivp, 1.0);
    EXPECT_TRUE(solution.status.code == StatusCode::blow_up || solution.status.code == StatusCode::non_finite)
        << scheme->info().name << ": " << solution.status.describe();
    EXPECT_TRUE(solution.state.allFinite());
    EXPECT_LT(solution.time, 100.0);
    EXPECT_EQ(solution.work.accepted_steps, static_cast<std::uint64_t>(solution.time));
  }
}

TEST(Schemes, RefuseTolerancesWhereTheyHaveAFixedStep) {
  NullObserver observer;
  EXPECT_THROW(splitting("velocity_verlet")->solve(random_network(16, {}, 1.0), AdaptiveStep{}, observer),
               InputError);
}

TEST(Schemes, CountTheirForces) {
  const Ivp ivp = random_network(17, {.is_damped = false}, 1.0);
  const auto forces = [&](const Integrator& scheme) { return run(scheme, ivp, 0.01).work.rhs_evaluations; };
  EXPECT_EQ(forces(*splitting("symplectic_euler")), 100u);
  EXPECT_EQ(forces(*splitting("velocity_verlet")), 101u);
  EXPECT_EQ(forces(*make_verlet(VerletVelocity::central)), 101u);
  EXPECT_EQ(forces(*make_verlet(VerletVelocity::backward)), 101u);
  for (const schemes::ButcherTableau& tableau : schemes::explicit_tableaus()) {
    // The last stage of a first-same-as-last scheme is the first of the next step; the first of all is not
    // spared.
    const auto scheme = make_explicit_runge_kutta(tableau);
    const auto stages = static_cast<unsigned>(scheme->info().stages);
    const bool first_same_as_last = schemes::is_first_same_as_last(tableau);
    EXPECT_EQ(stages, static_cast<unsigned>(tableau.stages()) - (first_same_as_last ? 1u : 0u));
    EXPECT_EQ(forces(*scheme), 100u * stages + (first_same_as_last ? 1u : 0u)) << tableau.name;
  }
}

}  // namespace
}  // namespace fw::integrators
