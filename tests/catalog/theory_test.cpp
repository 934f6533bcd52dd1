#include <gtest/gtest.h>

#include <string>

#include "analysis/theory/scheme_growth.hpp"
#include "catalog/methods.hpp"
#include "core/error.hpp"

namespace fw::catalog {
namespace {

using analysis::SchemeGrowth;
using analysis::Theory;

int stages_of(const std::string& call) {
  return std::get<schemes::ButcherTableau>(theory_of_call(call).coefficients).stages();
}

TEST(TheoryOfAMethod, IsMadeWithTheOptionsOfTheCall) {
  EXPECT_EQ(stages_of("rkc2"), 8);
  EXPECT_EQ(stages_of("rkc2[stages=5]"), 5);
  EXPECT_EQ(stages_of("rkc1[stages=12]"), 12);
  EXPECT_TRUE(std::holds_alternative<std::monostate>(theory_of_call("rkc2[stages=auto]").coefficients));
  EXPECT_DOUBLE_EQ(theory_of_call("newmark[beta=0.3025,gamma=0.6]").on_linear_systems.alpha.gamma, 0.6);
  EXPECT_DOUBLE_EQ(theory_of_call("hht_alpha[alpha=-0.3]").on_linear_systems.alpha.alpha_f, 0.3);
  EXPECT_DOUBLE_EQ(theory_of_call("hht_alpha").on_linear_systems.alpha.alpha_f, 0.1);
}

TEST(TheoryOfAMethod, DoesNotDependOnOptionsOfTheStepSizeController) {
  EXPECT_EQ(stages_of("dormand_prince_54[controller=i,safety=0.8]"), stages_of("dormand_prince_54"));
}

TEST(TheoryOfAMethod, RefusesWhatTheMethodRefuses) {
  EXPECT_THROW(theory_of_call("rkc2[stages=1]"), InputError);
  EXPECT_THROW(theory_of_call("newmark[beta=2]"), InputError);
  EXPECT_THROW(theory_of_call("rk4[stages=5]"), InputError);
  EXPECT_THROW(theory_of_call("rk5"), InputError);
}

/// What a study of damping knows, a study of stability knows too: there is one theory of a method.
TEST(TheoryOfAMethod, ThatIsKnownOnOscillationsIsKnownOnLinearSystems) {
  int known = 0;
  for (const MethodEntry& entry : methods()) {
    const Theory theory = entry.theory({});
    if (!analysis::oscillator_factors(theory)) continue;
    ++known;
    const bool has_rule = theory.on_linear_systems.rule != analysis::LinearRule::of_coefficients;
    EXPECT_TRUE(has_rule || !std::holds_alternative<std::monostate>(theory.on_linear_systems.data))
        << entry.name;
  }
  EXPECT_GE(known, 90);
}

TEST(TheoryOfAMethod, GrowsOnOscillationsByTheSameFactorByBothWays) {
  for (const char* call : {"newmark", "newmark[beta=0,gamma=0.5]", "hht_alpha[alpha=-0.3]",
                           "generalised_alpha[rho_infinity=0.5]", "average_vector_field", "discrete_gradient",
                           "implicit_euler_linearised", "verlet", "rkc2[stages=5]"}) {
    const Theory theory = theory_of_call(call);
    const SchemeGrowth growth(make_method(call), theory.on_linear_systems);
    EXPECT_NE(growth.basis(), analysis::GrowthBasis::single_steps) << call;
    const auto factors = analysis::oscillator_factors(theory);
    for (const double z : {0.1, 0.7, 1.9, 2.3, 8.0}) {
      const double radius = analysis::spectral_radius(factors, z);
      EXPECT_NEAR(growth.of_vibration(z * z, 0.0), radius, 1e-7 * (1.0 + radius)) << call << " at " << z;
    }
  }
}

TEST(TheoryOfAMethod, HasTheModifiedEnergiesOfTheSchemesThatCoincideWithTwoSplittings) {
  EXPECT_EQ(theory_of_call("velocity_verlet").modified_energy, analysis::velocity_verlet_energy);
  EXPECT_EQ(theory_of_call("verlet").modified_energy, analysis::velocity_verlet_energy);
  EXPECT_EQ(theory_of_call("symplectic_euler").modified_energy, analysis::symplectic_euler_energy);
  for (const char* other :
       {"symplectic_euler_b", "position_verlet", "forest_ruth", "verlet_backward_velocity"})
    EXPECT_EQ(theory_of_call(other).modified_energy, nullptr) << other;
}

}  // namespace
}  // namespace fw::catalog
