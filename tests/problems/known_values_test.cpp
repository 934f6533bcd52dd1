#include <gtest/gtest.h>

#include "analysis/reference/reference_solution.hpp"
#include "problems/digits.hpp"
#include "problems/every_problem.hpp"

namespace fw::problems {
namespace {

using analysis::certified_reference;

/// Compares all published digits at `time` with the certified reference, to half a unit of the last one.
void expect_published_digits(const Problem& problem, double time) {
  const auto reference = certified_reference(problem.ivp, time);
  ASSERT_TRUE(reference.status.ok()) << reference.status.describe();
  const auto& state = reference.states.at(0);
  int compared = 0;
  for (const KnownValue& known : problem.known_values) {
    if (known.time != time) continue;
    compared += 1;
    const auto i = static_cast<std::size_t>(known.component);
    const Float128 published(known.digits);
    EXPECT_LE(abs(state.value[i] - published), half_unit_of_last_digit(known.digits))
        << problem.name << " component " << i << ": published " << known.digits << ", reference "
        << state.value[i].str(34) << " +- " << static_cast<double>(state.error[i]);
  }
  EXPECT_GT(compared, 0);
}

TEST(KnownValues, OfKeplerAreReproducedToAllDigits) {
  expect_published_digits(kepler(), 100.0);
}
TEST(KnownValues, OfHenonHeilesAreReproducedToAllDigits) {
  expect_published_digits(henon_heiles(), 100.0);
}
TEST(KnownValues, OfPleiadesAreReproducedToAllDigits) {
  expect_published_digits(pleiades(), 3.0);
}
TEST(KnownValues, OfFermiPastaUlamAtTime1AreReproducedToAllDigits) {
  expect_published_digits(fermi_pasta_ulam(), 1.0);
}

TEST(KnownValues, OfKeplerAreReproducedByKeplersEquation) {
  const Problem problem = kepler();
  const auto state = problem.exact(Float128(100));
  for (const KnownValue& known : problem.known_values) {
    EXPECT_LE(abs(state[static_cast<std::size_t>(known.component)] - Float128(known.digits)),
              half_unit_of_last_digit(known.digits));
  }
}

TEST(KnownValues, AreNotMetWithOneDigitChanged) {
  const auto state = kepler().exact(Float128(100));
  const std::string wrong = "-0.1041832044341806047338596628";
  EXPECT_GT(abs(state[0] - Float128(wrong)), half_unit_of_last_digit(wrong));
}

TEST(FermiPastaUlam, HasThePublishedEnergyAndOscillatoryEnergies) {
  const Problem problem = fermi_pasta_ulam();
  // H = 1 + 1/2 + ((1 − 1/50)⁴ + (1 + 1/50)⁴)/4 = 2.00120008 exactly.
  EXPECT_NEAR(problem.invariants.at(0).value(0.0, problem.ivp.y0), 2.00120008, 1e-15);
  const auto reference = certified_reference(problem.ivp, 1.0);
  ASSERT_TRUE(reference.status.ok());
  const auto energies = oscillatory_energies<Float128>(reference.states[0].value, Float128(50));
  const char* published[] = {"1.004734940326732601", "0.001128950693931515", "0.000005395862256234"};
  ASSERT_EQ(energies.size(), 3u);
  for (std::size_t j = 0; j < 3; ++j) {
    EXPECT_LE(abs(energies[j] - Float128(published[j])), half_unit_of_last_digit(published[j]))
        << energies[j].str(30);
  }
}

}  // namespace
}  // namespace fw::problems
