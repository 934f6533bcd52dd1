#include "mechanics/spring_splitting.hpp"

#include <gtest/gtest.h>

#include "random_model.hpp"

namespace fw::mechanics {
namespace {

TEST(StiffSprings, AreThoseAboveTheGeometricMeanOfTheRates) {
  Springs springs;
  springs.first = {0, 0, 0, 0};
  springs.second = {1, 1, 1, 1};
  springs.stiffness = {1.0, 9.0, 11.0, 100.0};
  springs.damping = {0.0, 0.0, 0.0, 0.0};
  springs.rest_length = {1.0, 1.0, 1.0, 1.0};
  EXPECT_EQ(stiff_springs(springs), (std::vector<bool>{false, false, true, true}));
  // Under the strain law the rate is k/l₀: the second spring becomes the stiffest but one.
  springs.law = SpringLaw::strain;
  springs.rest_length = {1.0, 0.1, 2.0, 1.0};
  EXPECT_EQ(stiff_springs(springs), (std::vector<bool>{false, true, false, true}));
}

TEST(StiffSprings, AreAllWhereAllAreEqualAndNeverThoseWithoutStiffness) {
  Springs springs;
  springs.first = {0, 0, 0};
  springs.second = {1, 1, 1};
  springs.stiffness = {7.3, 0.0, 7.3};
  springs.damping = {0.0, 2.0, 0.0};
  springs.rest_length = {1.0, 1.0, 1.0};
  EXPECT_EQ(stiff_springs(springs), (std::vector<bool>{true, false, true}));
}

TEST(ForceSplitting, AddsUpToTheForceAndItsStiffPartIsThatOfTheStiffSpringsAlone) {
  RandomModels random(20261122);
  for (const SpringLaw law : all_laws) {
    for (int trial = 0; trial < 20; ++trial) {
      const MassSpringModel model = random.everything(law);
      const State state = random.state(model);
      const MassSpringSystem system(model);
      const ForceSplitting* splitting = system.force_splitting();
      ASSERT_NE(splitting, nullptr);

      const std::vector<bool> stiff = stiff_springs(model.springs);
      MassSpringModel stiff_only;
      stiff_only.mass = model.mass;
      stiff_only.fixed = model.fixed;
      stiff_only.springs = model.springs;
      for (std::size_t e = 0; e < stiff.size(); ++e) {
        if (!stiff[e]) stiff_only.springs.stiffness[e] = stiff_only.springs.damping[e] = 0.0;
      }
      const MassSpringSystem expected(stiff_only);
      Vector f(state.q.size()), f_stiff(f), f_soft(f), f_expected(f);
      system.force(0.3, state.q, state.v, f);
      splitting->stiff_force(0.3, state.q, state.v, f_stiff);
      splitting->soft_force(0.3, state.q, state.v, f_soft);
      expected.force(0.3, state.q, state.v, f_expected);
      EXPECT_GT(f_stiff.norm(), 0.0);
      EXPECT_GT(f_soft.norm(), 0.0);
      EXPECT_LE((f_stiff + f_soft - f).norm(), 1e-14 * f_stiff.norm());
      EXPECT_LE((f_stiff - f_expected).norm(), 1e-14 * f_stiff.norm());

      SparseMatrix K = system.tangent_pattern(), D(K), K_expected(K), D_expected(K);
      splitting->stiff_stiffness(0.3, state.q, state.v, K);
      splitting->stiff_damping(0.3, state.q, state.v, D);
      expected.stiffness(0.3, state.q, state.v, TangentModel::exact, K_expected);
      expected.damping(0.3, state.q, state.v, D_expected);
      EXPECT_LE((K - K_expected).norm(), 1e-14 * K.norm());
      EXPECT_LE((D - D_expected).norm(), 1e-14 * D.norm());
    }
  }
}

TEST(ForceSplitting, IsMissingWhereNoSpringIsStiff) {
  MassSpringModel model;
  model.mass = {1.0};
  EXPECT_EQ(MassSpringSystem(model).force_splitting(), nullptr);
}

}  // namespace
}  // namespace fw::mechanics
