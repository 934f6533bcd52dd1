#include "mechanics/spring_splitting.hpp"

#include <gtest/gtest.h>

#include "random_model.hpp"

namespace fw::mechanics {
namespace {

/// Which springs of a model are stiff, numbered through all groups.
std::vector<bool> stiff_springs(const MassSpringModel& model) {
  std::vector<bool> stiff;
  for (const std::vector<bool>& batch : stiff_elements(assemble<ElementBatch>(model)->rates())) {
    stiff.insert(stiff.end(), batch.begin(), batch.end());
  }
  return stiff;
}

MassSpringModel parallel_springs(std::vector<double> stiffness, std::vector<double> rest_length) {
  MassSpringModel model;
  model.mass = {1.0, 1.0};
  const std::size_t count = stiffness.size();
  model.springs.first.assign(count, 0);
  model.springs.second.assign(count, 1);
  model.springs.stiffness = std::move(stiffness);
  model.springs.damping.assign(count, 0.0);
  model.springs.rest_length = std::move(rest_length);
  return model;
}

TEST(StiffSprings, AreThoseAboveTheGeometricMeanOfTheRates) {
  MassSpringModel model = parallel_springs({1.0, 9.0, 11.0, 100.0}, {1.0, 1.0, 1.0, 1.0});
  EXPECT_EQ(stiff_springs(model), (std::vector<bool>{false, false, true, true}));
  // Under the strain law the rate is k/l₀: the second spring becomes the stiffest but one.
  model = parallel_springs({1.0, 9.0, 11.0, 100.0}, {1.0, 0.1, 2.0, 1.0});
  model.springs.law = SpringLaw::strain;
  EXPECT_EQ(stiff_springs(model), (std::vector<bool>{false, true, false, true}));
  // Groups are judged by one mean, each with the rate of its law: 1, 9, 110, 100.
  model = parallel_springs({1.0, 9.0, 11.0, 100.0}, {1.0, 0.1, 0.1, 1.0});
  model.springs.groups = {{"", SpringLaw::hooke, 2}, {"", SpringLaw::strain, 2}};
  EXPECT_EQ(stiff_springs(model), (std::vector<bool>{false, false, true, true}));
}

TEST(StiffSprings, AreAllWhereAllAreEqualAndNeverThoseWithoutStiffness) {
  const MassSpringModel model = parallel_springs({7.3, 0.0, 7.3}, {1.0, 1.0, 1.0});
  EXPECT_EQ(stiff_springs(model), (std::vector<bool>{true, false, true}));
}

TEST(ForceSplitting, AddsUpToTheForceAndItsStiffPartIsThatOfTheStiffSpringsAlone) {
  RandomModels random(20261122);
  for (const SpringLaw law : all_laws) {
    for (int trial = 0; trial < 20; ++trial) {
      const MassSpringModel model = trial % 2 == 0 ? random.everything(law) : random.everything_in_groups();
      const State state = random.state(model);
      const MassSpringSystem system(model);
      const ForceSplitting* splitting = system.force_splitting();
      ASSERT_NE(splitting, nullptr);

      const std::vector<bool> stiff = stiff_springs(model);
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
