#include <gtest/gtest.h>

#include "core/error.hpp"
#include "extended_list.hpp"
#include "random_model.hpp"

namespace fw::mechanics {
namespace {

TEST(ChangeOfElements, GivesTheForcesAndMatricesOfANewSystem) {
  RandomModels random(20261210);
  MassSpringSystem system(random.everything(SpringLaw::hooke));
  const State state = random.state(system.model());
  dense_stiffness(system, state);
  const ForceSplitting* splitting = system.force_splitting();
  ASSERT_NE(splitting, nullptr);
  MassSpringModel changed = system.model();
  changed.springs = random.network(SpringLaw::strain, 8, 11, true).springs;
  changed.gravity = {1.0, 2.0, 3.0};
  changed.obstacles.pop_back();
  const MassSpringSystem expected(changed);
  system.change_elements(changed);
  EXPECT_EQ(force_of(system, state), force_of(expected, state));
  EXPECT_EQ(dense_stiffness(system, state), dense_stiffness(expected, state));
  EXPECT_EQ(dense_damping(system, state), dense_damping(expected, state));
  EXPECT_EQ(system.energies(state.q, state.v).total(), expected.energies(state.q, state.v).total());
  Vector stiff(state.q.size()), stiff_expected(state.q.size());
  EXPECT_EQ(system.force_splitting(), splitting) << "who holds it keeps it";
  splitting->stiff_force(0.0, state.q, state.v, stiff);
  expected.force_splitting()->stiff_force(0.0, state.q, state.v, stiff_expected);
  EXPECT_EQ(stiff, stiff_expected);
  EXPECT_EQ(system.element_revision(), 1u);
}

TEST(ChangeOfElements, CountsANewPatternThenAndOnlyThen) {
  RandomModels random(20261211);
  MassSpringModel model = random.network(SpringLaw::hooke, 6, 6, true);
  model.springs.first[0] = 0;
  model.springs.second[0] = 1;
  MassSpringSystem system(model);
  SparseMatrix old = system.tangent_pattern();
  EXPECT_EQ(system.pattern_revision(), 0u);

  MassSpringModel same = model;  // the same pairs in another order, one of them twice
  std::swap(same.springs.first[0], same.springs.second[0]);
  std::swap(same.springs.first[1], same.springs.first[4]);
  std::swap(same.springs.second[1], same.springs.second[4]);
  random.add_spring(same.springs, 1, 0, true);
  system.change_elements(same);
  EXPECT_EQ(system.pattern_revision(), 0u);
  EXPECT_EQ(system.element_revision(), 1u);
  const State state = random.state(same);
  system.stiffness(0.0, state.q, state.v, TangentModel::exact, old);
  EXPECT_EQ(Matrix(old), dense_stiffness(MassSpringSystem(same), state));

  MassSpringModel other = model;  // the only spring that joins 0 and 1 goes
  other.springs.second[0] = 5;
  for (std::size_t e = 1; e < other.springs.size(); ++e) {
    if (other.springs.first[e] + other.springs.second[e] == 1) {
      other.springs.first[e] = 4;
      other.springs.second[e] = 5;
    }
  }
  system.change_elements(other);
  EXPECT_EQ(system.pattern_revision(), 1u);
  EXPECT_EQ(system.block_pattern().revision(), 1u);
  EXPECT_EQ(dense_stiffness(system, state), dense_stiffness(MassSpringSystem(other), state));
}

TEST(ChangeOfElements, LeavesTheSystemAsItIsWhereTheModelIsBad) {
  RandomModels random(20261212);
  MassSpringSystem system(random.everything(SpringLaw::hooke));
  const State state = random.state(system.model());
  const Vector before = force_of(system, state);
  MassSpringModel bad = system.model();
  bad.springs.stiffness[3] = -1.0;
  EXPECT_THROW(system.change_elements(bad), InputError);
  bad = system.model();
  bad.mass.push_back(1.0);
  EXPECT_THROW(system.change_elements(bad), InputError);
  EXPECT_EQ(force_of(system, state), before);
  EXPECT_EQ(system.model().springs.stiffness.size(), 16u);
  EXPECT_GT(system.model().springs.stiffness[3], 0.0);
  EXPECT_EQ(system.element_revision(), 0u);
}

TEST(ChangeOfElements, ReadsFurtherElementsAgain) {
  RandomModels random(20261213);
  const auto further = std::make_shared<std::vector<TestBatch>>();
  further->push_back(TriangleAreaBatch{{{{0, 1, 2}, 0.5, 20.0, 0.1}}});
  MassSpringSystem system(random.network(SpringLaw::hooke, 6, 5, true),
                          with_elements(std::shared_ptr<const std::vector<TestBatch>>(further)));
  const State state = random.state(system.model());
  const Index before = system.tangent_pattern().nonZeros();
  std::get<TriangleAreaBatch>((*further)[0]).triangles.push_back({{3, 4, 5}, 0.4, 30.0, 0.0});
  MassSpringModel bare = system.model();
  bare.springs = {};
  system.change_elements(bare);
  EXPECT_EQ(system.pattern_revision(), 1u);
  EXPECT_EQ(system.tangent_pattern().nonZeros(), 9 * (6 + 2 * 6));
  EXPECT_NE(system.tangent_pattern().nonZeros(), before);
  const auto [K, D] = complex_step_tangents(system.elements(), state);
  EXPECT_LE(relative_deviation(dense_stiffness(system, state), K), 1e-12);
  EXPECT_LE(relative_deviation(dense_damping(system, state), D), 1e-13);
}

}  // namespace
}  // namespace fw::mechanics
