#include "integrators/tableau/linear_multistep.hpp"

#include <algorithm>
#include <stdexcept>

#include "core/error.hpp"
#include "integrators/loop/starting_steps.hpp"
#include "order_levels.hpp"
#include "schemes/multistep_formulas.hpp"

namespace fw::integrators {
namespace {

std::unique_ptr<Integrator> make(const std::string& name) {
  for (const auto& formula : schemes::multistep_formulas()) {
    if (formula.name == name) return make_linear_multistep(formula);
  }
  throw std::logic_error("no formula " + name);
}

/// Fine enough for the asymptotic range of the order, coarse enough to stay above rounding.
struct Levels {
  int coarsest;
  double refinement;
};
Levels mechanical_levels(const Integrator& scheme) {
  const int order = scheme.info().order;
  if (order <= 4) return {250, std::numbers::sqrt2};
  return order == 5 ? Levels{350, std::pow(2.0, 0.25)} : Levels{170, std::pow(2.0, 0.2)};
}
Levels first_order_levels(const Integrator& scheme) {
  const int order = scheme.info().order;
  if (order <= 4) return {250, std::numbers::sqrt2};
  return order == 5 ? Levels{150, std::pow(2.0, 0.2)} : Levels{70, std::pow(2.0, 0.25)};
}

/// Order 6 has its asymptotic range within two decades of rounding: the conformance suite measures it in
/// binary128.
constexpr int highest_order_in_double = 5;

TEST(LinearMultistep, ConvergesWithTheOrderOfItsFormulaOnMechanicalSystems) {
  for (const auto& formula : schemes::multistep_formulas()) {
    const auto scheme = make_linear_multistep(formula);
    EXPECT_EQ(scheme->info().order, formula.name.back() - '0');
    if (scheme->info().order > highest_order_in_double) continue;
    const Levels levels = mechanical_levels(*scheme);
    expect_claimed_orders(*scheme, levels.coarsest, 8, levels.refinement);
  }
}

TEST(LinearMultistep, ConvergesWithTheOrderOfItsFormulaOnFirstOrderSystems) {
  const Ivp ivp = first_order_flow();
  const Vector reference = certified_end(ivp);
  for (const auto& formula : schemes::multistep_formulas()) {
    const auto scheme = make_linear_multistep(formula);
    if (scheme->info().order > highest_order_in_double) continue;
    const Levels levels = first_order_levels(*scheme);
    expect_order(*scheme, ivp, reference, scheme->info().order, levels.coarsest, 8, "first order",
                 levels.refinement);
  }
}

TEST(LinearMultistep, SeesAWrongCoefficientOfBdf2) {
  // Negative control: 3/2 in place of 4/3, rescaled to keep the sum of α at zero, is not of order 2.
  schemes::MultistepFormula wrong = schemes::multistep_formulas().at(8);
  ASSERT_EQ(wrong.name, "bdf2");
  wrong.alpha = {"1/2", "-3/2", 1};
  const Ivp ivp = driven_chain(true);
  const Vector reference = certified_end(ivp);
  const auto scheme = make_linear_multistep(wrong);
  EXPECT_LT(scheme->info().order, 2);
  const ObservedOrders observed = observed_orders(*scheme, ivp, reference, 60, 8, std::numbers::sqrt2);
  EXPECT_FALSE(observed.position.valid && observed.position.order > 0.5);  // does not converge at all
}

/// ẏ = n t^{n−1}, y = tⁿ.
struct Power {
  int exponent;

  template <class S>
  void operator()(const S& t, std::span<const S>, std::span<S> dydt) const {
    dydt[0] = S(exponent);
    for (int i = 1; i < exponent; ++i) dydt[0] *= t;
  }
};

TEST(LinearMultistep, IsExactForPolynomialsOfItsOrder) {
  for (const auto& formula : schemes::multistep_formulas()) {
    const auto scheme = make_linear_multistep(formula);
    for (const int excess : {0, 1}) {
      const int exponent = scheme->info().order + excess;
      Ivp ivp;
      ivp.system = std::make_shared<FunctorSystem<Power>>(1, Power{exponent});
      ivp.y0 = Vector{{0.0}};
      ivp.t1 = 2.0;
      const double error = std::abs(run(*scheme, ivp, 0.125).state[0] - std::pow(2.0, exponent));
      if (excess == 0) {
        EXPECT_LT(error, 1e-11) << formula.name;
      } else {
        EXPECT_GT(error, 1e-7) << formula.name;  // negative control: one degree more is not exact
      }
    }
  }
}

TEST(LinearMultistep, RefusesABrokenIntervalUnlessItIsAOneStepScheme) {
  const Ivp ivp = random_network(14, {}, 1.0);
  for (const auto& formula : schemes::multistep_formulas()) {
    const auto scheme = make_linear_multistep(formula);
    EXPECT_EQ(scheme->info().is_multistep, formula.name != "adams_moulton2");
    if (scheme->info().is_multistep) {
      EXPECT_THROW(run(*scheme, ivp, 0.3), InputError) << formula.name;
    } else {
      EXPECT_TRUE(run(*scheme, ivp, 0.3).status.ok());
    }
  }
}

TEST(LinearMultistep, EndsWellInFewerStepsThanItsFormulaHas) {
  Ivp ivp = driven_chain(true, 1e-3);
  const Vector reference = certified_end(ivp);
  for (const auto& formula : schemes::multistep_formulas()) {
    if (formula.steps() < 3) continue;
    const Solution solution = run(*make_linear_multistep(formula), ivp, 5e-4);
    ASSERT_TRUE(solution.status.ok());
    EXPECT_EQ(solution.work.accepted_steps, 2u);
    EXPECT_LT((solution.state - reference).norm(), 1e-10) << formula.name;
  }
}

TEST(LinearMultistep, OfAdamsBashforthCostsOneRightHandSidePerStepAfterTheStart) {
  const Ivp ivp = random_network(17, {}, 1.0);
  for (const auto& formula : schemes::multistep_formulas()) {
    if (formula.name.rfind("adams_bashforth", 0) != 0) continue;
    const auto k = static_cast<std::uint64_t>(formula.steps());
    const std::uint64_t columns = (static_cast<std::uint64_t>(formula.name.back() - '0') + 1) / 2;
    // The midpoint rules with 2, 4, … substeps share their first right-hand side.
    const std::uint64_t start = 1 + columns * (columns + 1) - columns;
    EXPECT_EQ(run(*make_linear_multistep(formula), ivp, 0.01).work.rhs_evaluations, 100 + (k - 1) * start)
        << formula.name;
  }
}

TEST(StartingSteps, HaveALocalErrorOfTheirOrder) {
  const auto local_error = [](bool is_explicit, int order, double h) {
    Ivp ivp = first_order_flow();
    ivp.t1 = ivp.t0 + h;
    Work work;
    const auto stepper = is_explicit ? make_explicit_starting_steps(ivp, order, work)
                                     : make_implicit_starting_steps(ivp, order, work);
    Vector y = ivp.y0;
    EXPECT_TRUE(stepper->step(ivp.t0, h, y).ok());
    return (y - certified_end(ivp)).norm();
  };
  for (const int order : {2, 3, 4, 5, 6}) {
    for (const bool is_explicit : {true, false}) {
      const int claimed = is_explicit ? 2 * ((order + 1) / 2) : order;
      const double h = claimed <= 3 ? 0.01 : 0.08;
      const double slope =
          std::log2(local_error(is_explicit, order, h) / local_error(is_explicit, order, 0.5 * h));
      EXPECT_NEAR(slope, claimed + 1, 0.4) << order << (is_explicit ? " explicit" : " implicit");
    }
  }
}

struct StiffSpring {
  template <class S>
  void operator()(const S&, std::span<const S> q, std::span<const S>, std::span<S> f) const {
    f[0] = S(-1e6) * q[0];
  }
};

TEST(Bdf2, DampsAStiffSpringAtOnceAndTheTrapezoidalRuleDoesNot) {
  // m q̈ = −k q with hω = 1000: two BDF2 steps remove it, the trapezoidal rule keeps it for ever.
  Ivp ivp;
  ivp.system = std::make_shared<FunctorSecondOrderSystem<StiffSpring>>(Vector{{1.0}}, ForceClass::position,
                                                                       StiffSpring{});
  ivp.y0 = Vector{{1.0, 0.0}};
  ivp.t1 = 100.0;
  EXPECT_LT(run(*make("bdf2"), ivp, 1.0).state.norm(), 1e-12);
  const Vector kept = run(*make("adams_moulton2"), ivp, 1.0).state;
  EXPECT_NEAR(1e6 * kept[0] * kept[0] + kept[1] * kept[1], 1e6, 1e-3);
}

}  // namespace
}  // namespace fw::integrators
