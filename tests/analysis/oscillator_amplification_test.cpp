#include "analysis/theory/oscillator_amplification.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "integrators/structural/generalised_alpha.hpp"
#include "schemes/explicit_tableaus.hpp"
#include "schemes/implicit_tableaus.hpp"
#include "schemes/multistep_formulas.hpp"
#include "schemes/splitting_schemes.hpp"

namespace fw::analysis {
namespace {

template <class List>
AmplificationFactors factors_of(const List& list, const std::string& name) {
  for (const auto& entry : list) {
    if (entry.name == name) return amplification_factors(entry);
  }
  throw std::logic_error("no scheme " + name);
}

NumericalOscillation at(const AmplificationFactors& factors, double z) {
  return numerical_oscillations(factors, {z}).front();
}

TEST(OscillatorAmplification, OfTheEulerSchemesIsInClosedForm) {
  const auto explicit_euler = factors_of(schemes::explicit_tableaus(), "explicit_euler");
  const auto implicit_euler = factors_of(schemes::diagonally_implicit_tableaus(), "implicit_euler");
  for (const double z : {0.01, 0.3, 1.0, 4.0}) {
    EXPECT_NEAR(std::abs(at(explicit_euler, z).factor), std::sqrt(1.0 + z * z), 1e-13);
    EXPECT_NEAR(std::abs(at(implicit_euler, z).factor), 1.0 / std::sqrt(1.0 + z * z), 1e-13);
    EXPECT_NEAR(at(explicit_euler, z).phase, std::atan(z), 1e-13);
    EXPECT_NEAR(at(implicit_euler, z).damping_ratio(), 0.5 * std::log1p(z * z) / std::atan(z), 1e-13);
    EXPECT_NEAR(at(implicit_euler, z).period_error(z), z / std::atan(z) - 1.0, 1e-13);
  }
}

TEST(OscillatorAmplification, OfVerletIsUndampedWithAPeriodThatIsTooShort) {
  const auto verlet = factors_of(schemes::splitting_schemes(), "velocity_verlet");
  for (const double z : {0.05, 0.5, 1.9}) {
    EXPECT_NEAR(std::abs(at(verlet, z).factor), 1.0, 1e-13);
    EXPECT_NEAR(at(verlet, z).phase, 2.0 * std::asin(0.5 * z), 1e-12);
  }
  EXPECT_FALSE(at(verlet, 2.5).oscillates);
  EXPECT_TRUE(std::isnan(at(verlet, 2.5).damping_ratio()));
  EXPECT_NEAR(at(verlet, 2.5).spectral_radius, 4.0, 1e-12);  // ζ² + 4.25 ζ + 1
}

TEST(OscillatorAmplification, OfRk4FollowsThePhaseBeyondAHalfTurn) {
  const auto rk4 = factors_of(schemes::explicit_tableaus(), "rk4");
  // |R|² = 1 − z⁶/72 + z⁸/576.
  EXPECT_NEAR(std::norm(at(rk4, 1.5).factor), 1.0 - std::pow(1.5, 6) / 72.0 + std::pow(1.5, 8) / 576.0,
              1e-12);
  EXPECT_GT(at(rk4, 6.0).phase, 3.2);
}

TEST(OscillatorAmplification, OfMultistepFormulasHasParasiticFactors) {
  const auto bdf2 = factors_of(schemes::multistep_formulas(), "bdf2");
  const NumericalOscillation small = at(bdf2, 1e-2);
  EXPECT_NEAR(small.factor.real(), std::cos(1e-2), 1e-5);
  EXPECT_NEAR(small.factor.imag(), std::sin(1e-2), 1e-5);
  EXPECT_NEAR(small.parasitic_ratio, 1.0 / 3.0, 0.01);  // ρ = (ζ − 1)(ζ − 1/3)
  // ln λ = i z − z⁴/4 + …: third order in the damping ratio.
  EXPECT_NEAR(small.damping_ratio(), 0.25e-6, 0.01e-6);
}

TEST(OscillatorAmplification, OfGeneralisedAlphaHasTheRadiusAtInfinityThatItIsMadeFor) {
  for (const double rho : {0.0, 0.5, 0.8, 1.0}) {
    const auto factors = amplification_factors(integrators::alpha_parameters({.rho_infinity = rho}));
    EXPECT_NEAR(spectral_radius_at_infinity(factors), rho, 2e-4) << rho;
  }
}

TEST(OscillatorAmplification, KnowsWhatHappensToInfinitelyFastOscillations) {
  EXPECT_TRUE(std::isinf(spectral_radius_at_infinity(factors_of(schemes::explicit_tableaus(), "rk4"))));
  EXPECT_TRUE(
      std::isinf(spectral_radius_at_infinity(factors_of(schemes::splitting_schemes(), "symplectic_euler"))));
  EXPECT_EQ(
      spectral_radius_at_infinity(factors_of(schemes::diagonally_implicit_tableaus(), "implicit_euler")),
      0.0);
  EXPECT_NEAR(spectral_radius_at_infinity(factors_of(schemes::diagonally_implicit_tableaus(), "trapezoidal")),
              1.0, 1e-9);
}

}  // namespace
}  // namespace fw::analysis
