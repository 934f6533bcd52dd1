#include <gtest/gtest.h>

#include "analysis/gauss_collocation.hpp"
#include "analysis/reference/reference_solution.hpp"
#include "problems/digits.hpp"
#include "problems/every_problem.hpp"

namespace fw::problems {
namespace {

using analysis::certified_reference;

TEST(KnownValuesSlow, OfFermiPastaUlamAtTime10AreReproducedToAllDigits) {
  const Problem problem = fermi_pasta_ulam();
  const auto reference = certified_reference(problem.ivp, 10.0);
  ASSERT_TRUE(reference.status.ok()) << reference.status.describe();
  int compared = 0;
  for (const KnownValue& known : problem.known_values) {
    if (known.time != 10.0) continue;
    compared += 1;
    const auto i = static_cast<std::size_t>(known.component);
    EXPECT_LE(abs(reference.states[0].value[i] - Float128(known.digits)),
              half_unit_of_last_digit(known.digits))
        << reference.states[0].value[i].str(30);
  }
  EXPECT_EQ(compared, 2);
}

/// Two unrelated methods agree far beyond the published digits and both deny the last one.
void expect_last_digit_refuted(const Problem& problem, double time, int steps,
                               const std::vector<std::pair<std::size_t, std::string>>& published) {
  const auto reference = certified_reference(problem.ivp, time);
  ASSERT_TRUE(reference.status.ok()) << reference.status.describe();
  const auto collocation = analysis::GaussCollocation(12).integrate(problem.ivp, time, steps);
  for (const auto& [i, digits] : published) {
    const Float128 value = reference.states[0].value[i];
    EXPECT_LT(static_cast<double>(abs(value - collocation[i])), 1e-20)
        << value.str(30) << " " << collocation[i].str(30);
    EXPECT_GT(abs(value - Float128(digits)), half_unit_of_last_digit(digits)) << value.str(30);
    EXPECT_LT(abs(value - Float128(digits)), 4 * half_unit_of_last_digit(digits)) << value.str(30);
  }
}

TEST(PublishedLastDigits, OfThreePleiadesAreRefutedByTwoMethods) {
  expect_last_digit_refuted(
      pleiades(), 3.0, 3000,
      {{2, "-3.222559032418324"}, {9, "5.225081843456543"}, {12, "-0.2429682344935824"}});
}

TEST(PublishedLastDigits, OfFermiPastaUlamAtTime1AreCutOffInsteadOfRounded) {
  expect_last_digit_refuted(fermi_pasta_ulam(), 1.0, 200, {{1, "0.53980860868328140"}});
}

TEST(KnownValuesSlow, OfRobertsonAreReproducedAndItsSumStaysOne) {
  const Problem problem = robertson();
  const std::vector<double> times = {0.4, 4.0, 40.0};
  const auto reference = certified_reference(problem.ivp, times);
  ASSERT_TRUE(reference.status.ok()) << reference.status.describe();
  for (const auto& state : reference.states) {
    EXPECT_LT(static_cast<double>(abs(state.value[0] + state.value[1] + state.value[2] - 1)), 1e-30);
  }
  for (const KnownValue& known : problem.known_values) {
    EXPECT_LE(abs(reference.states.back().value[static_cast<std::size_t>(known.component)] -
                  Float128(known.digits)),
              half_unit_of_last_digit(known.digits));
  }
}

}  // namespace
}  // namespace fw::problems
