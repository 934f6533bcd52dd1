
#include "core/error.hpp"
#include "integrators/structural/generalised_alpha.hpp"
#include "integrators/structural/hht_alpha.hpp"
#include "integrators/structural/newmark.hpp"
#include "order_levels.hpp"

namespace fw::integrators {
namespace {

TEST(StructuralDynamics, SchemesConvergeWithTheirOrder) {
  for (const double beta : {0.0, 1.0 / 6.0, 0.25, 0.3}) {
    expect_claimed_orders(*make_newmark({.beta = beta}), 40, 8);
  }
  const auto damped = make_newmark({.beta = 0.36, .gamma = 0.7});
  EXPECT_EQ(damped->info().order, 1);
  expect_claimed_orders(*damped, 80, 9);
  for (const double alpha : {-1.0 / 3.0, -0.1, 0.0})
    expect_claimed_orders(*make_hht_alpha({.alpha = alpha}), 40, 8);
  for (const double rho : {0.0, 0.5, 0.8, 1.0}) {
    const auto scheme = make_generalised_alpha({.rho_infinity = rho});
    EXPECT_EQ(scheme->info().order, 2);
    expect_claimed_orders(*scheme, 60, 8);
  }
}

/// A unit mass on a spring of unit stiffness; its step map on (q, v) and the scheme's own acceleration.
struct UnitSpring {
  template <class S>
  void operator()(const S&, std::span<const S> q, std::span<const S>, std::span<S> f) const {
    f[0] = -q[0];
  }
};

/// How the state of an unit oscillator shrinks per step at frequency × step = `phase` after many steps: the
/// spectral radius of the amplification matrix, whatever hidden variables the scheme keeps.
double decay_per_step(const Integrator& scheme, double phase) {
  Ivp ivp;
  ivp.system = std::make_shared<FunctorSecondOrderSystem<UnitSpring>>(Vector{{1.0}}, ForceClass::position,
                                                                      UnitSpring{});
  ivp.y0 = Vector{{1.0, 0.3}};
  const int steps = 400;
  ivp.t1 = steps * phase;
  TrajectoryRecorder recorder;
  EXPECT_TRUE(scheme.solve(ivp, FixedStep{.step = phase}, recorder).status.ok());
  // Largest norm in two windows, in units where energy is a norm; windows smooth the oscillation of the norm.
  const auto largest = [&](std::size_t from) {
    double value = 0.0;
    for (std::size_t i = from; i < from + 40; ++i) value = std::max(value, recorder.states()[i].norm());
    return value;
  };
  return std::pow(largest(240) / largest(40), 1.0 / 200.0);
}

TEST(GeneralisedAlpha, HasTheSpectralRadiusAtInfinityThatIsAskedFor) {
  for (const double rho : {0.3, 0.5, 0.8, 1.0}) {
    EXPECT_NEAR(decay_per_step(*make_generalised_alpha({.rho_infinity = rho}), 1e4), rho, 0.02) << rho;
    EXPECT_NEAR(decay_per_step(*make_generalised_alpha({.rho_infinity = rho}), 0.02), 1.0, 1e-4) << rho;
  }
}

TEST(HhtAlpha, HasTheSpectralRadiusAtInfinityOfItsTheory) {
  // At infinite frequency the eigenvalues of HHT-α are α/(1 + α) and, twice, (1 + α)/(1 − α)·(−1)
  // [Hilber, Hughes, Taylor 1977; Hughes 1987, 9.3].
  for (const double alpha : {-0.3, -0.1, -0.05}) {
    const double expected = std::max(std::abs(alpha / (1.0 + alpha)), (1.0 + alpha) / (1.0 - alpha));
    EXPECT_NEAR(decay_per_step(*make_hht_alpha({.alpha = alpha}), 1e4), expected, 0.02) << alpha;
  }
}

TEST(Newmark, WithAverageAccelerationKeepsTheEnergyOfALinearSpring) {
  EXPECT_NEAR(decay_per_step(*make_newmark(), 1e3), 1.0, 1e-9);
  EXPECT_LT(decay_per_step(*make_newmark({.beta = 0.36, .gamma = 0.7}), 1e3), 0.9);  // negative control
}

TEST(Newmark, WithoutBetaIsVelocityVerlet) {
  for (const bool damped : {false, true}) {
    const Ivp ivp = random_network(41, {.is_damped = damped}, 0.5);
    const Solution newmark = run(*make_newmark({.beta = 0.0}), ivp, 1.0 / 512.0);
    const Solution verlet = run(*splitting("velocity_verlet"), ivp, 1.0 / 512.0);
    ASSERT_TRUE(newmark.status.ok());
    EXPECT_LT((newmark.state - verlet.state).norm(), 1e-11 * verlet.state.norm()) << damped;
    if (!damped) {
      EXPECT_EQ(newmark.work.rhs_evaluations, verlet.work.rhs_evaluations);
      EXPECT_EQ(newmark.work.factorisations, 0u);
    }
  }
}

TEST(Newmark, IsStableBeyondTheLimitOfVerletOnlyIfImplicit) {
  EXPECT_TRUE(make_newmark()->info().is_a_stable);
  EXPECT_FALSE(make_newmark({.beta = 1.0 / 6.0})->info().is_a_stable);
  EXPECT_FALSE(make_newmark({.beta = 0.0})->info().is_a_stable);
  // Linear acceleration: hω ≤ 2√3 = 3.464.
  EXPECT_NEAR(decay_per_step(*make_newmark({.beta = 1.0 / 6.0}), 3.45), 1.0, 1e-2);
  EXPECT_GT(decay_per_step(*make_newmark({.beta = 1.0 / 6.0}), 3.48), 1.05);
}

TEST(StructuralDynamics, RefusesParametersOutOfRange) {
  EXPECT_THROW(make_newmark({.beta = -0.1}), InputError);
  EXPECT_THROW(make_newmark({.gamma = 0.4}), InputError);
  EXPECT_THROW(make_hht_alpha({.alpha = 0.1}), InputError);
  EXPECT_THROW(make_hht_alpha({.alpha = -0.4}), InputError);
  EXPECT_THROW(make_generalised_alpha({.rho_infinity = 1.1}), InputError);
}

TEST(StructuralDynamics, StaysInEquilibrium) {
  // A hanging mass at rest: the residual is rounding, and Newton's iteration has to accept it.
  mechanics::MassSpringModel model;
  model.mass = {1.0, 2.0};
  model.fixed = {0};
  model.gravity = {0.0, 0.0, -9.81};
  model.springs = {.first = {0}, .second = {1}, .stiffness = {1e4}, .damping = {0.0}, .rest_length = {1.0}};
  Ivp ivp;
  ivp.y0 = Vector::Zero(12);
  ivp.y0[5] = -1.0 - 2.0 * 9.81 / 1e4;
  ivp.system = std::make_shared<const mechanics::MassSpringSystem>(std::move(model));
  for (const auto& scheme : {make_newmark(), make_hht_alpha(), make_generalised_alpha()}) {
    const Solution solution = run(*scheme, ivp, 0.01);
    EXPECT_TRUE(solution.status.ok()) << scheme->info().name << solution.status.describe();
    EXPECT_LT((solution.state - ivp.y0).norm(), 1e-10);
  }
}

}  // namespace
}  // namespace fw::integrators
