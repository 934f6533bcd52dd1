#include "analysis/theory/scheme_growth.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "analysis/theory/growth_matrices.hpp"
#include "analysis/theory/linearised_system.hpp"
#include "analysis/theory/stability_limit.hpp"
#include "integrators/special/verlet.hpp"
#include "integrators/structural/generalised_alpha.hpp"
#include "integrators/structural/hht_alpha.hpp"
#include "integrators/structural/newmark.hpp"
#include "integrators/tableau/explicit_runge_kutta.hpp"
#include "integrators/tableau/linear_multistep.hpp"
#include "integrators/tableau/splitting.hpp"
#include "problems/cloth.hpp"
#include "problems/linear_chain.hpp"
#include "schemes/explicit_tableaus.hpp"
#include "schemes/multistep_formulas.hpp"
#include "schemes/splitting_schemes.hpp"

namespace fw::analysis {
namespace {

template <class Data>
const Data& named(const std::vector<Data>& list, const std::string& name) {
  for (const Data& entry : list) {
    if (entry.name == name) return entry;
  }
  throw std::logic_error("no " + name);
}

SchemeGrowth runge_kutta(const std::string& name, bool by_steps = false) {
  const schemes::ButcherTableau& tableau = named(schemes::explicit_tableaus(), name);
  const std::shared_ptr<const Integrator> integrator = integrators::make_explicit_runge_kutta(tableau, {});
  return {integrator, by_steps ? schemes::SchemeData{} : schemes::SchemeData{tableau}};
}

SchemeGrowth splitting(const std::string& name, bool by_steps = false) {
  const schemes::SplittingScheme& scheme = named(schemes::splitting_schemes(), name);
  const std::shared_ptr<const Integrator> integrator = integrators::make_splitting(scheme);
  return {integrator, by_steps ? schemes::SchemeData{} : schemes::SchemeData{scheme}};
}

TEST(SchemeGrowth, IsTheSameFromCoefficientsAndFromSingleSteps) {
  for (const Complex z : {Complex(-0.5, 0.0), Complex(-0.3, 1.2), Complex(0.0, 0.9), Complex(-2.9, 0.1)}) {
    EXPECT_NEAR(runge_kutta("rk4").of_eigenvalue(z), runge_kutta("rk4", true).of_eigenvalue(z), 1e-12);
    EXPECT_NEAR(splitting("position_verlet").of_vibration(std::norm(z) / 4.0, -z.real()),
                splitting("position_verlet", true).of_vibration(std::norm(z) / 4.0, -z.real()), 1e-9);
  }
}

TEST(SchemeGrowth, OfTheTwoStepVerletSchemesIsThatOfTheirRecurrences) {
  // (1 + b/2) x₊ = (2 − a) x − (1 − b/2) x₋ with the central, x₊ = (2 − a − b) x − (1 − b) x₋ with the
  // backward velocity.
  const auto root = [](double p, double q) {  // of ζ² = p ζ + q
    const Complex disc = std::sqrt(Complex(0.25 * p * p + q));
    return std::max(std::abs(0.5 * p + disc), std::abs(0.5 * p - disc));
  };
  const SchemeGrowth central(integrators::make_verlet(integrators::VerletVelocity::central), LinearScheme{});
  const SchemeGrowth backward(integrators::make_verlet(integrators::VerletVelocity::backward),
                              LinearScheme{});
  for (const auto& [a, b] : {std::pair{0.7, 0.0}, {3.9, 0.0}, {4.3, 0.0}, {1.5, 0.4}, {0.2, 1.1}}) {
    EXPECT_NEAR(central.of_vibration(a, b), root((2 - a) / (1 + b / 2), -(1 - b / 2) / (1 + b / 2)), 1e-8);
    EXPECT_NEAR(backward.of_vibration(a, b), root(2 - a - b, -(1 - b)), 1e-8);
    // By the rule, without a step of the code.
    const SchemeGrowth central_rule(integrators::make_verlet(integrators::VerletVelocity::central),
                                    LinearScheme{{}, LinearRule::verlet_central_velocity});
    const SchemeGrowth backward_rule(integrators::make_verlet(integrators::VerletVelocity::backward),
                                     LinearScheme{{}, LinearRule::verlet_backward_velocity});
    EXPECT_NEAR(central_rule.of_vibration(a, b), central.of_vibration(a, b), 1e-8);
    EXPECT_NEAR(backward_rule.of_vibration(a, b), backward.of_vibration(a, b), 1e-8);
  }
}

TEST(SchemeGrowth, OfAnExactSchemeIsTheExponential) {
  const SchemeGrowth exact(integrators::make_verlet(integrators::VerletVelocity::central),
                           LinearScheme{{}, LinearRule::exact});
  for (const Complex z : {Complex(-0.5, 0.0), Complex(-0.3, 1.2), Complex(0.0, 0.9)}) {
    EXPECT_NEAR(exact.of_eigenvalue(z), std::exp(z.real()), 1e-12);
  }
}

/// The polynomial, the matrix and steps of the code are three ways to one number; explicit central
/// differences lose stability at ωh = 2.
TEST(SchemeGrowth, OfTheAlphaFamilyIsThatOfItsPolynomialItsMatrixAndItsSteps) {
  const auto rule = [](const integrators::AlphaParameters& parameters) {
    return LinearScheme{.rule = LinearRule::alpha_family, .alpha = parameters};
  };
  const integrators::NewmarkOptions damped{.beta = 0.3025, .gamma = 0.6};
  const SchemeGrowth newmark(integrators::make_newmark(damped), rule(alpha_parameters(damped)));
  const SchemeGrowth steps(integrators::make_newmark(damped), LinearScheme{});
  for (const auto& [a, b] : {std::pair{0.7, 0.0}, {3.9, 0.0}, {50.0, 0.0}, {1.5, 0.4}, {0.2, 1.1}}) {
    EXPECT_NEAR(newmark.of_vibration(a, b), steps.of_vibration(a, b), 1e-9);
    for (const auto& parameters :
         {alpha_parameters(damped), alpha_parameters(integrators::HhtAlphaOptions{.alpha = -0.3}),
          alpha_parameters(integrators::GeneralisedAlphaOptions{.rho_infinity = 0.4})}) {
      const Matrix m = alpha_step_matrix(parameters, Matrix::Constant(1, 1, a), Matrix::Constant(1, 1, b));
      EXPECT_NEAR(alpha_growth(parameters, a, b), spectral_radius(m), 1e-7);
    }
  }
  const integrators::AlphaParameters central{.beta = 0.0, .gamma = 0.5};
  EXPECT_NEAR(alpha_growth(central, 3.999, 0.0), 1.0, 1e-15);
  EXPECT_GT(alpha_growth(central, 4.001, 0.0), 1.001);
  EXPECT_EQ(alpha_growth(integrators::AlphaParameters{}, 1e12, 0.0), 1.0) << "average acceleration, far out";
}

TEST(SchemeGrowth, KnowsWhichSchemesAreUnstableAtEveryStep) {
  const auto multistep = [](const std::string& name) {
    const schemes::MultistepFormula& formula = named(schemes::multistep_formulas(), name);
    return SchemeGrowth(integrators::make_linear_multistep(formula), formula).grows_at_every_step();
  };
  for (const char* name : {"explicit_euler", "midpoint", "heun", "fehlberg_54"})
    EXPECT_TRUE(runge_kutta(name).grows_at_every_step()) << name;
  for (const char* name : {"kutta3", "rk4"}) EXPECT_FALSE(runge_kutta(name).grows_at_every_step()) << name;
  EXPECT_TRUE(runge_kutta("heun", true).grows_at_every_step());
  EXPECT_FALSE(runge_kutta("rk4", true).grows_at_every_step());
  EXPECT_TRUE(multistep("adams_bashforth2"));
  EXPECT_FALSE(multistep("adams_bashforth3"));
  EXPECT_FALSE(multistep("adams_bashforth4"));
  EXPECT_FALSE(multistep("bdf2"));
  EXPECT_FALSE(splitting("velocity_verlet").grows_at_every_step());
}

TEST(SchemeGrowth, OfTheWholeStepIsThatOfSingleStepsWhereDampersCouple) {
  const Problem cloth = problems::cloth({{"count", 2.0}, {"stiffness", 50.0}, {"damping", 0.2}});
  const SecondOrderSystem& system = *cloth.ivp.system->second_order();
  const Index n = system.degrees_of_freedom();
  const auto linear =
      std::make_shared<const LinearisedSystem>(system, 0.0, cloth.ivp.y0.head(n), cloth.ivp.y0.tail(n));
  const LinearModes modes = linear_modes(*linear, 0.0, Vector::Zero(2 * n), 100);
  ASSERT_GT(modes.coupling, 1e-3);
  const double h = 1.5 / modes.spectral_radius;
  for (const char* name : {"velocity_verlet", "symplectic_euler", "blanes_moan4"}) {
    const double by_stages = splitting(name).of_system(modes, h, linear);
    EXPECT_NEAR(by_stages, splitting(name, true).of_system(modes, h, linear), 1e-6) << name;
    const double by_modes = splitting(name).of_system(modes, h, nullptr);
    EXPECT_NEAR(by_stages, by_modes, 0.2) << name;
  }
}

TEST(PredictedLimit, OfASplittingWithCoupledDampersEndsAtItsNarrowGap) {
  // Yoshida's sixth-order scheme is unstable for h omega from 2.269 to 2.328 and stable beyond, up to 2.8.
  const Problem cloth = problems::cloth({{"count", 3.0}, {"damping", 1e-4}});
  const SecondOrderSystem& system = *cloth.ivp.system->second_order();
  const Index n = system.degrees_of_freedom();
  const auto linear =
      std::make_shared<const LinearisedSystem>(system, 0.0, cloth.ivp.y0.head(n), cloth.ivp.y0.tail(n));
  const LinearModes modes = linear_modes(*linear, 0.0, Vector::Zero(2 * n), 100);
  ASSERT_GT(modes.coupling, 1e-6);
  const SchemeGrowth growth = splitting("yoshida6");
  const double unit = 1.0 / modes.spectral_radius;
  const double limit = predicted_limit(growth, modes, linear, true, 0.05 * unit, 1000.0 * unit);
  EXPECT_NEAR(limit / unit, 2.269, 0.01);
  EXPECT_LE(growth.of_system(modes, 0.998 * limit, linear), 1.0 + 1e-6);
  EXPECT_GT(growth.of_system(modes, 1.005 * limit, linear), 1.0 + 1e-6);
}

TEST(LinearModes, OfAChainAreThoseInClosedForm) {
  const Problem chain = problems::linear_chain({{"count", 6.0}, {"mass", 0.5}, {"stiffness", 30.0}});
  const LinearModes modes = linear_modes(*chain.ivp.system, 0.0, chain.ivp.y0, 100);
  ASSERT_EQ(modes.vibrations.size(), 6u);
  ASSERT_EQ(modes.eigenvalues.size(), 12u);
  EXPECT_TRUE(modes.is_undamped);
  EXPECT_EQ(modes.growing, 0);
  for (int j = 1; j <= 6; ++j) {
    const double omega = 2.0 * std::sqrt(60.0) * std::sin(j * std::numbers::pi / 14.0);
    EXPECT_NEAR(modes.vibrations[static_cast<std::size_t>(j - 1)].omega_squared, omega * omega, 1e-10);
  }
  EXPECT_NEAR(modes.spectral_radius, chain.stiffness(), 1e-12);
  const LinearModes large = linear_modes(*chain.ivp.system, 0.0, chain.ivp.y0, 4);
  EXPECT_FALSE(large.is_complete);
  EXPECT_NEAR(large.spectral_radius, chain.stiffness(), 1e-8);
}

TEST(LinearModes, OfALargeDampedSystemAreTheOuterOnesOfAllModes) {
  const Problem cloth = problems::cloth({{"count", 4.0}, {"damping", 0.3}});
  const LinearModes all = linear_modes(*cloth.ivp.system, 0.0, cloth.ivp.y0, 1000);
  const LinearModes outer = linear_modes(*cloth.ivp.system, 0.0, cloth.ivp.y0, 10);
  ASSERT_TRUE(outer.status.ok()) << outer.status.describe();
  EXPECT_FALSE(outer.is_complete);
  EXPECT_NEAR(outer.spectral_radius, all.spectral_radius, 1e-6 * all.spectral_radius);
}

TEST(LinearModes, TellLinearProblemsFromOthers) {
  const Problem chain = problems::linear_chain({}), cloth = problems::cloth({});
  EXPECT_TRUE(is_linear(*chain.ivp.system, 0.0, chain.ivp.y0));
  EXPECT_FALSE(is_linear(*cloth.ivp.system, 0.0, cloth.ivp.y0));
}

TEST(LinearisedSystem, HasTheJacobianOfTheOriginal) {
  const Problem cloth = problems::cloth({});
  const SecondOrderSystem& system = *cloth.ivp.system->second_order();
  const Index n = system.degrees_of_freedom();
  const LinearisedSystem linear(system, 0.0, cloth.ivp.y0.head(n), cloth.ivp.y0.tail(n));
  SparseMatrix original = cloth.ivp.system->jacobian_pattern(), found = linear.jacobian_pattern();
  cloth.ivp.system->jacobian(0.0, cloth.ivp.y0, original);
  linear.jacobian(0.0, cloth.ivp.y0, found);
  Vector w = Vector::LinSpaced(2 * n, -1.0, 1.0);
  for (Index i = 0; i < n; ++i) {
    if (system.fixed()[static_cast<std::size_t>(i)]) w[i] = w[n + i] = 0.0;
  }
  const Vector expected = original * w;
  EXPECT_LT((found * w - expected).cwiseAbs().maxCoeff(), 1e-12 * expected.cwiseAbs().maxCoeff());
  Vector slope(2 * n), product(2 * n);
  linear.rhs(0.0, w, slope);
  EXPECT_LT((slope - expected).cwiseAbs().maxCoeff(), 1e-12 * expected.cwiseAbs().maxCoeff());
  linear.jacobian_product(0.0, w, w, product);
  EXPECT_EQ(product, slope);
  std::vector<Float128> wide(w.begin(), w.end()), wide_slope(wide.size());
  linear.rhs(Float128(0), wide, wide_slope);
  for (Index i = 0; i < 2 * n; ++i)
    EXPECT_NEAR(static_cast<double>(wide_slope[static_cast<std::size_t>(i)]), slope[i],
                1e-12 * expected.cwiseAbs().maxCoeff());
  // The parts add up.
  const ForceSplitting& parts = *linear.force_splitting();
  Vector stiff(n), soft(n), force(n);
  parts.stiff_force(0.0, w.head(n), w.tail(n), stiff);
  parts.soft_force(0.0, w.head(n), w.tail(n), soft);
  linear.force(0.0, w.head(n), w.tail(n), force);
  EXPECT_LT((stiff + soft - force).cwiseAbs().maxCoeff(), 1e-12 * force.cwiseAbs().maxCoeff());
}

TEST(LargestStableStep, FindsANarrowGapWhereItIsTold) {
  const auto stable = [](double h) { return h < 0.9 || (h > 0.905 && h < 1.0); };
  const LimitSearch plain{.first = 0.1, .ratio = 1.5, .farthest = 10.0};
  LimitSearch careful = plain;
  careful.watched = 0.9;
  EXPECT_NEAR(largest_stable_step(stable, plain), 1.0, 2e-3);
  EXPECT_NEAR(largest_stable_step(stable, careful), 0.9, 2e-3);
  EXPECT_TRUE(std::isinf(largest_stable_step([](double) { return true; }, plain)));
  EXPECT_TRUE(std::isinf(largest_stable_step([](double) { return true; }, careful)));
  EXPECT_EQ(largest_stable_step([](double) { return false; }, plain), 0.0);
  EXPECT_NEAR(largest_stable_step([](double h) { return h < 0.03; }, plain), 0.03, 1e-4);
}

}  // namespace
}  // namespace fw::analysis
