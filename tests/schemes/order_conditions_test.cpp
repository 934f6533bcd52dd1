#include "schemes/order_conditions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "schemes/derived_properties.hpp"
#include "schemes/explicit_tableaus.hpp"
#include "schemes/high_order_explicit_tableaus.hpp"
#include "schemes/implicit_tableaus.hpp"
#include "schemes/nystrom_tableaus.hpp"
#include "schemes/rooted_trees.hpp"
#include "schemes/rosenbrock_tableaus.hpp"
#include "schemes/splitting_schemes.hpp"
#include "schemes/stability_function.hpp"

namespace fw::schemes {
namespace {

template <class List>
const auto& find_in(const List& list, const std::string& name) {
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const auto& entry) { return entry.name == name; });
  if (found == list.end()) throw std::logic_error("no scheme " + name);
  return *found;
}

const ButcherTableau& tableau_named(const std::string& name) {
  for (const auto* list :
       {&explicit_tableaus(), &diagonally_implicit_tableaus(), &fully_implicit_tableaus()}) {
    if (std::any_of(list->begin(), list->end(), [&](const ButcherTableau& t) { return t.name == name; })) {
      return find_in(*list, name);
    }
  }
  throw std::logic_error("no tableau " + name);
}

LinearStability stability_of(const std::string& name) {
  return linear_stability(stability_function(tableau_named(name)));
}

std::vector<int> counts_by_order(const auto& trees, int orders) {
  std::vector<int> counts(static_cast<std::size_t>(orders), 0);
  for (const auto& tree : trees) {
    if (tree.order <= orders) ++counts[static_cast<std::size_t>(tree.order) - 1];
  }
  return counts;
}

TEST(RootedTrees, AreAsManyAsCounted) {
  // The sequence A000081.
  EXPECT_EQ(counts_by_order(rooted_trees(10), 10), (std::vector<int>{1, 1, 2, 4, 9, 20, 48, 115, 286, 719}));
}

TEST(RootedTrees, HaveLabellingsThatAddUpToAFactorial) {
  // Σ_τ ρ!/(γσ) over the trees of order ρ counts the increasing labellings of all rooted trees: (ρ − 1)!
  // [Hairer, Nørsett, Wanner 1993, II.2].
  std::vector<double> sums(11, 0.0);
  for (const RootedTree& tree : rooted_trees(10)) {
    sums[static_cast<std::size_t>(tree.order)] +=
        std::tgamma(tree.order + 1.0) / (tree.density * tree.symmetry);
  }
  for (int order = 1; order <= 10; ++order) {
    EXPECT_NEAR(sums[static_cast<std::size_t>(order)] / std::tgamma(order), 1.0, 1e-13) << order;
  }
}

TEST(ColouredTrees, AreAsManyAsCounted) {
  // Rooted trees with two kinds of vertices, the sequence A000151.
  EXPECT_EQ(counts_by_order(coloured_trees(6), 6), (std::vector<int>{2, 4, 14, 52, 214, 916}));
}

TEST(NystromTrees, AreAsManyAsCounted) {
  // Special Nyström trees by the order of the velocity: 1, 1, 2, 3, 6, 10 [Hairer, Nørsett, Wanner 1993,
  // II.14].
  EXPECT_EQ(counts_by_order(nystrom_trees(6, false), 6), (std::vector<int>{1, 1, 2, 3, 6, 10}));
}

TEST(OrderOfAccuracy, InBinary128IsThatOfExactArithmeticForEveryRationalTableau) {
  int rational = 0;
  for (const auto* list :
       {&explicit_tableaus(), &diagonally_implicit_tableaus(), &fully_implicit_tableaus()}) {
    for (const ButcherTableau& tableau : *list) {
      if (!is_rational(tableau)) continue;
      ++rational;
      const TableauValues<Rational> exact = values<Rational>(tableau);
      EXPECT_EQ(order_of_accuracy(tableau), order_of_weights(exact, exact.b, 0.0)) << tableau.name;
      if (exact.b_embedded.empty()) continue;
      EXPECT_EQ(embedded_order(tableau), order_of_weights(exact, exact.b_embedded, 0.0)) << tableau.name;
    }
  }
  EXPECT_GE(rational, 15);
}

TEST(OrderOfAccuracy, InExactArithmeticFallsByTheSmallestMistake) {
  // 1e-15 moved from b₂ to b₃ keeps all Σ b c^k, for c₂ = c₃, but not b·Ac = 1/6; then the sum of weights is
  // wrong.
  TableauValues<Rational> exact = values<Rational>(tableau_named("rk4"));
  const Rational mistake(1, 1'000'000'000'000'000);
  exact.b[1] -= mistake;
  exact.b[2] += mistake;
  EXPECT_EQ(order_of_weights(exact, exact.b, 0.0), 2);
  exact.b[1] += mistake;
  EXPECT_EQ(order_of_weights(exact, exact.b, 0.0), 0);
}

TEST(QuadratureOrder, IsThatOfTheQuadratureFormula) {
  // Simpson's rule 4, Gauss with s nodes 2s, Radau 2s − 1, Lobatto 2s − 2.
  const auto order = [](const char* name) {
    return quadrature_order(values<Float128>(tableau_named(name)), 1e-25);
  };
  EXPECT_EQ(order("rk4"), 4);
  EXPECT_EQ(order("gauss2"), 4);
  EXPECT_EQ(order("gauss3"), 6);
  EXPECT_EQ(order("radau_iia2"), 3);
  EXPECT_EQ(order("radau_iia3"), 5);
  EXPECT_EQ(order("lobatto_iiia3"), 4);
  EXPECT_EQ(order("lobatto_iiia4"), 6);
  EXPECT_EQ(order("heun3"), 3);
}

TEST(PrincipalError, IsThatOfTheLiterature) {
  // By hand for schemes of two stages; Dormand–Prince 5(4): 3.99e-4 [Dormand, Prince 1980].
  EXPECT_NEAR(principal_error(tableau_named("explicit_euler")), 0.5, 1e-15);
  // Midpoint: b·c² − 1/3 = −1/12 with σ = 2, b·Ac − 1/6 = −1/6.
  EXPECT_NEAR(principal_error(tableau_named("midpoint")), std::hypot(1.0 / 24.0, 1.0 / 6.0), 1e-15);
  EXPECT_NEAR(principal_error(tableau_named("heun")), std::hypot(1.0 / 12.0, 1.0 / 6.0), 1e-15);
  EXPECT_NEAR(principal_error(tableau_named("dormand_prince_54")), 3.99e-4, 0.005e-4);
}

TEST(StabilityFunction, OfKnownSchemesIsThatOfTheLiterature) {
  const auto expect = [](const char* name, const std::vector<double>& numerator,
                         const std::vector<double>& denominator) {
    const StabilityFunction R = stability_function(tableau_named(name));
    ASSERT_EQ(R.numerator.size(), numerator.size()) << name;
    ASSERT_EQ(R.denominator.size(), denominator.size()) << name;
    for (std::size_t k = 0; k < numerator.size(); ++k) {
      EXPECT_NEAR(static_cast<double>(R.numerator[k]), numerator[k], 1e-15) << name << " P, " << k;
    }
    for (std::size_t k = 0; k < denominator.size(); ++k) {
      EXPECT_NEAR(static_cast<double>(R.denominator[k]), denominator[k], 1e-15) << name << " Q, " << k;
    }
  };
  expect("explicit_euler", {1, 1}, {1});
  expect("rk4", {1, 1, 0.5, 1.0 / 6, 1.0 / 24}, {1});
  expect("dormand_prince_54", {1, 1, 0.5, 1.0 / 6, 1.0 / 24, 1.0 / 120, 1.0 / 600}, {1});
  expect("implicit_euler", {1}, {1, -1});
  expect("trapezoidal", {1, 0.5}, {1, -0.5});
  expect("implicit_midpoint", {1, 0.5}, {1, -0.5});
  // Padé approximations [Hairer, Wanner 1996, IV.3, table 3.1].
  expect("gauss2", {1, 0.5, 1.0 / 12}, {1, -0.5, 1.0 / 12});
  expect("gauss3", {1, 0.5, 0.1, 1.0 / 120}, {1, -0.5, 0.1, -1.0 / 120});
  expect("radau_iia2", {1, 1.0 / 3}, {1, -2.0 / 3, 1.0 / 6});
  expect("radau_iia3", {1, 0.4, 0.05}, {1, -0.6, 0.15, -1.0 / 60});
  expect("lobatto_iiic2", {1}, {1, -1, 0.5});
  expect("lobatto_iiic3", {1, 0.25}, {1, -0.75, 0.25, -1.0 / 24});
}

TEST(LinearStability, OfExplicitSchemesHasTheIntervalsOfTheLiterature) {
  // [Hairer, Wanner 1996, IV.2]; the interval of rk4 is the real root of r³ − 4r² + 12r = 24.
  EXPECT_NEAR(stability_of("explicit_euler").real_interval, 2.0, 1e-9);
  EXPECT_NEAR(stability_of("heun").real_interval, 2.0, 1e-9);
  EXPECT_NEAR(stability_of("kutta3").real_interval, 2.5127453266, 1e-9);
  EXPECT_NEAR(stability_of("rk4").real_interval, 2.7852935634, 1e-9);
  EXPECT_NEAR(stability_of("dormand_prince_54").real_interval, 3.3066, 5e-4);
  EXPECT_NEAR(stability_of("kutta3").imaginary_interval, std::sqrt(3.0), 1e-9);
  EXPECT_NEAR(stability_of("rk4").imaginary_interval, std::sqrt(8.0), 1e-9);
  EXPECT_EQ(stability_of("explicit_euler").imaginary_interval, 0.0);
  EXPECT_EQ(stability_of("heun").imaginary_interval, 0.0);
}

TEST(LinearStability, OfImplicitSchemesIsThatOfTheLiterature) {
  for (const char* name :
       {"implicit_euler", "sdirk2", "tr_bdf2", "radau_iia2", "radau_iia3", "lobatto_iiic3"}) {
    EXPECT_TRUE(stability_of(name).is_l_stable) << name;
    EXPECT_EQ(stability_of(name).alpha_degrees, 90.0) << name;
  }
  for (const char* name : {"implicit_midpoint", "trapezoidal", "gauss2", "gauss3", "lobatto_iiia3"}) {
    EXPECT_TRUE(stability_of(name).is_a_stable) << name;
    EXPECT_FALSE(stability_of(name).is_l_stable) << name;
    EXPECT_NEAR(stability_of(name).at_infinity, 1.0, 1e-12) << name;
    EXPECT_EQ(stability_of(name).dissipation_order, -1) << name;
  }
  for (const char* name : {"heun", "rk4", "dormand_prince_54"})
    EXPECT_FALSE(stability_of(name).is_a_stable) << name;
}

TEST(LinearStability, HasTheErrorConstantsOfTaylorAndPade) {
  // e^z − R(z): 1/120 z⁵ for rk4; (−1)ˢ (s!)²/((2s)! (2s + 1)!) for Gauss's Padé approximations.
  EXPECT_NEAR(stability_of("rk4").error_constant, 1.0 / 120.0, 1e-15);
  EXPECT_EQ(stability_of("rk4").order, 4);
  EXPECT_NEAR(stability_of("implicit_midpoint").error_constant, -1.0 / 12.0, 1e-15);
  EXPECT_NEAR(stability_of("gauss2").error_constant, 1.0 / 720.0, 1e-15);
  EXPECT_NEAR(stability_of("gauss3").error_constant, -1.0 / 100800.0, 1e-17);
}

TEST(LinearStability, HasTheDispersionAndDissipationOfRk4) {
  // R(iy): |R|² = 1 − y⁶/72 + y⁸/576, arg R = y − y⁵/120 + ….
  EXPECT_EQ(stability_of("rk4").dissipation_order, 5);
  EXPECT_EQ(stability_of("rk4").dispersion_order, 4);
}

TEST(LinearStability, OfRosenbrockMethodsIsThatOfTheLiterature) {
  const auto of = [](const char* name) {
    return linear_stability(stability_function(find_in(rosenbrock_tableaus(), name)));
  };
  for (const char* name : {"rosenbrock_euler", "ros2", "rodas3", "rodas4", "rodasp"}) {
    EXPECT_TRUE(of(name).is_l_stable) << name;
  }
  // ROS3P: |R(∞)| = 0.73 [Lang, Verwer 2001].
  EXPECT_TRUE(of("ros3p").is_a_stable);
  EXPECT_NEAR(of("ros3p").at_infinity, std::sqrt(3.0) - 1.0, 1e-12);
}

TEST(AlgebraicStability, HoldsForGaussAndRadauAndNotForLobattoIIIA) {
  // [Hairer, Wanner 1996, IV.12].
  for (const char* name : {"implicit_euler", "implicit_midpoint", "gauss2", "gauss3", "radau_iia2",
                           "radau_iia3", "lobatto_iiic2", "lobatto_iiic3"}) {
    EXPECT_TRUE(is_algebraically_stable(tableau_named(name))) << name;
  }
  for (const char* name : {"trapezoidal", "lobatto_iiia3", "lobatto_iiib3", "rk4"}) {
    EXPECT_FALSE(is_algebraically_stable(tableau_named(name))) << name;
  }
}

TEST(OscillatorStability, OfVerletEndsAtTwo) {
  const SplittingScheme& verlet = find_in(splitting_schemes(), "velocity_verlet");
  const OscillatorStability stability = oscillator_stability(as_nystrom(verlet));
  EXPECT_NEAR(stability.interval, 2.0, 1e-9);
  EXPECT_EQ(stability.dispersion_order, 2);
  EXPECT_EQ(stability.dissipation_order, -1);
  // Triple jump of order 4: 1.573 [McLachlan, Gray 1997; Blanes, Casas, Murua 2008].
  EXPECT_NEAR(oscillator_stability(as_nystrom(find_in(splitting_schemes(), "forest_ruth"))).interval, 1.573,
              5e-4);
}

}  // namespace
}  // namespace fw::schemes
