#include "schemes/multistep_properties.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "schemes/multistep_formulas.hpp"

namespace fw::schemes {
namespace {

const MultistepFormula& formula_named(const std::string& name) {
  const auto& list = multistep_formulas();
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const auto& formula) { return formula.name == name; });
  if (found == list.end()) throw std::logic_error("no formula " + name);
  return *found;
}

/// The backward differentiation formula of order k from its definition Σ_{m=1}^{k} (1/m) ∇^m y_{n+k} = h
/// f_{n+k}.
MultistepFormula backward_differentiation(int k) {
  std::vector<Rational> alpha(static_cast<std::size_t>(k) + 1, 0);
  for (int m = 1; m <= k; ++m) {
    Rational binomial = 1;
    for (int i = 0; i <= m; ++i) {
      alpha[static_cast<std::size_t>(k - i)] += (i % 2 == 0 ? binomial : Rational(-binomial)) / m;
      binomial = binomial * (m - i) / (i + 1);
    }
  }
  MultistepFormula formula{.name = "generated"};
  for (const Rational& a : alpha) {
    const Rational scaled = a / alpha.back();
    formula.alpha.emplace_back(scaled.str());
    formula.beta.emplace_back(0);
  }
  formula.beta.back() = Coefficient(Rational(1 / alpha.back()).str());
  return formula;
}

TEST(MultistepFormulas, HaveTheOrderThatTheirNamesSay) {
  ASSERT_EQ(multistep_formulas().size(), 13u);
  for (const MultistepFormula& formula : multistep_formulas()) {
    EXPECT_EQ(order_of_accuracy(formula), formula.name.back() - '0') << formula.name;
    EXPECT_TRUE(is_zero_stable(formula)) << formula.name;
    EXPECT_FALSE(formula.reference.empty());
  }
}

TEST(MultistepFormulas, HaveTheErrorConstantsOfTheLiterature) {
  // [Hairer, Nørsett, Wanner 1993, III.2, tables 2.1 and 2.2, and −1/(k+1) for BDF].
  EXPECT_EQ(error_constant(formula_named("adams_bashforth2")), Rational(5, 12));
  EXPECT_EQ(error_constant(formula_named("adams_bashforth3")), Rational(3, 8));
  EXPECT_EQ(error_constant(formula_named("adams_bashforth4")), Rational(251, 720));
  EXPECT_EQ(error_constant(formula_named("adams_bashforth5")), Rational(95, 288));
  EXPECT_EQ(error_constant(formula_named("adams_moulton2")), Rational(-1, 12));
  EXPECT_EQ(error_constant(formula_named("adams_moulton3")), Rational(-1, 24));
  EXPECT_EQ(error_constant(formula_named("adams_moulton4")), Rational(-19, 720));
  EXPECT_EQ(error_constant(formula_named("adams_moulton5")), Rational(-3, 160));
  for (int k = 2; k <= 6; ++k)
    EXPECT_EQ(error_constant(formula_named("bdf" + std::to_string(k))), Rational(-1, k + 1));
}

TEST(MultistepFormulas, OfBackwardDifferentiationFollowFromBackwardDifferences) {
  for (int k = 2; k <= 6; ++k) {
    const MultistepFormula generated = backward_differentiation(k);
    const MultistepFormula& typed = formula_named("bdf" + std::to_string(k));
    for (std::size_t j = 0; j < typed.alpha.size(); ++j) {
      EXPECT_EQ(as<Rational>(typed.alpha[j]), as<Rational>(generated.alpha[j])) << k << " " << j;
      EXPECT_EQ(as<Rational>(typed.beta[j]), as<Rational>(generated.beta[j])) << k << " " << j;
    }
  }
}

TEST(OrderOfAccuracy, FallsWhereACoefficientIsWrong) {
  MultistepFormula wrong = formula_named("bdf2");
  wrong.alpha[1] = "-3/2";  // in place of −4/3
  EXPECT_LT(order_of_accuracy(wrong), 1);
  wrong = formula_named("adams_bashforth4");
  std::swap(wrong.beta[0], wrong.beta[1]);
  EXPECT_EQ(order_of_accuracy(wrong), 1);
}

TEST(ZeroStability, HoldsForBackwardDifferentiationUpToSixStepsOnly) {
  EXPECT_TRUE(is_zero_stable(backward_differentiation(6)));
  EXPECT_EQ(order_of_accuracy(backward_differentiation(7)), 7);
  EXPECT_FALSE(is_zero_stable(backward_differentiation(7)));
}

TEST(ZeroStability, FailsForADoubleRootOnTheCircle) {
  const MultistepFormula formula{.name = "double", .alpha = {1, -2, 1}, .beta = {0, 0, 0}};
  EXPECT_FALSE(is_zero_stable(formula));
}

TEST(StabilityAngle, IsThatOfTheLiterature) {
  // [Hairer, Wanner 1996, V.2, table 2.1].
  EXPECT_EQ(stability_angle(formula_named("bdf2")), 90.0);
  EXPECT_NEAR(stability_angle(formula_named("bdf3")), 86.03, 0.005);
  EXPECT_NEAR(stability_angle(formula_named("bdf4")), 73.35, 0.005);
  EXPECT_NEAR(stability_angle(formula_named("bdf5")), 51.84, 0.005);
  EXPECT_NEAR(stability_angle(formula_named("bdf6")), 17.84, 0.005);
  EXPECT_EQ(stability_angle(formula_named("adams_moulton2")), 90.0);
  EXPECT_EQ(stability_angle(formula_named("adams_moulton3")), 0.0);
  EXPECT_EQ(stability_angle(formula_named("adams_bashforth2")), 0.0);
}

TEST(StabilityAngle, SeparatesStableFromUnstableSteps) {
  for (const char* name : {"bdf3", "bdf4", "bdf5", "bdf6"}) {
    const double alpha = stability_angle(formula_named(name));
    double largest_inside = 0.0, largest_outside = 0.0;
    for (double radius = 1e-3; radius < 1e4; radius *= 1.02) {
      const auto growth = [&](double degrees) {
        const double radians = degrees * 3.14159265358979324 / 180.0;
        return amplification(formula_named(name), -radius * std::cos(radians), radius * std::sin(radians));
      };
      largest_inside = std::max(largest_inside, growth(alpha - 0.2));
      largest_outside = std::max(largest_outside, growth(alpha + 0.2));
    }
    EXPECT_LT(largest_inside, 1.0) << name;
    EXPECT_GT(largest_outside, 1.0) << name;
  }
}

TEST(Stability, OfAandLIsThatOfTheLiterature) {
  for (const MultistepFormula& formula : multistep_formulas()) {
    EXPECT_EQ(is_a_stable(formula), formula.name == "bdf2" || formula.name == "adams_moulton2")
        << formula.name;
    EXPECT_EQ(is_l_stable(formula), formula.name == "bdf2") << formula.name;
  }
}

TEST(Amplification, LeavesTheRealAxisOfAdamsBashforthAtItsLimit) {
  EXPECT_LE(amplification(formula_named("adams_bashforth2"), -0.999, 0.0), 1.0);
  EXPECT_GT(amplification(formula_named("adams_bashforth2"), -1.001, 0.0), 1.0);
  EXPECT_LE(amplification(formula_named("adams_bashforth3"), -6.0 / 11.0 + 1e-3, 0.0), 1.0);
  EXPECT_GT(amplification(formula_named("adams_bashforth3"), -6.0 / 11.0 - 1e-3, 0.0), 1.0);
}

}  // namespace
}  // namespace fw::schemes
