#include "mechanics/assembly/block_pattern.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <thread>

#include "core/error.hpp"
#include "ode/first_order_jacobian.hpp"
#include "random_model.hpp"
#include "sparse/sparse_slots.hpp"

namespace fw::mechanics {
namespace {

bool same_structure(const SparseMatrix& a, const SparseMatrix& b) {
  return a.rows() == b.rows() && a.nonZeros() == b.nonZeros() &&
         std::equal(a.outerIndexPtr(), a.outerIndexPtr() + a.cols() + 1, b.outerIndexPtr()) &&
         std::equal(a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros(), b.innerIndexPtr());
}

std::set<std::pair<int, int>> entries(const SparseMatrix& matrix) {
  std::set<std::pair<int, int>> result;
  for (int column = 0; column < matrix.outerSize(); ++column) {
    int previous = -1;
    for (SparseMatrix::InnerIterator it(matrix, column); it; ++it) {
      EXPECT_GT(it.row(), previous);  // ascending, no repetition
      previous = static_cast<int>(it.row());
      EXPECT_EQ(it.value(), 0.0);
      result.emplace(it.row(), column);
    }
  }
  return result;
}

TEST(BlockPattern, HasABlockPerParticleAndTwoPerPairOfNeighboursAndNoOther) {
  RandomModels random(20260601);
  const MassSpringModel model = random.network(SpringLaw::hooke, 10, 30, true);  // with repeated pairs
  const BlockPattern pattern(10, assemble<ElementBatch>(model)->cliques());
  std::set<std::pair<int, int>> blocks;
  for (int i = 0; i < 10; ++i) blocks.emplace(i, i);
  for (std::size_t e = 0; e < 30; ++e) {
    blocks.emplace(model.springs.first[e], model.springs.second[e]);
    blocks.emplace(model.springs.second[e], model.springs.first[e]);
  }
  ASSERT_LT(blocks.size(), 70u);
  std::set<std::pair<int, int>> tangent, jacobian;
  for (const auto& [i, j] : blocks) {
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) {
        const int row = 3 * i + a, column = 3 * j + b;
        tangent.emplace(row, column);
        jacobian.emplace(30 + row, column);
        jacobian.emplace(30 + row, 30 + column);
      }
    }
  }
  for (int c = 0; c < 30; ++c) {
    jacobian.emplace(c, c);
    jacobian.emplace(c, 30 + c);
  }
  EXPECT_EQ(entries(pattern.tangent()), tangent);
  EXPECT_EQ(entries(pattern.jacobian()), jacobian);
}

TEST(BlockPattern, PutsBlocksWhereTheFirstOrderJacobianHasThem) {
  RandomModels random(20260605);
  const MassSpringModel model = random.network(SpringLaw::hooke, 7, 15, true);
  const std::vector<Cliques> cliques = assemble<ElementBatch>(model)->cliques();
  const BlockPattern pattern(7, cliques);
  const SparseMatrix K = pattern.tangent(), J = pattern.jacobian();
  EXPECT_TRUE(same_structure(J, FirstOrderJacobian(K).pattern()));
  for (int c = 0; c < 21; ++c) EXPECT_EQ(pattern.jacobian_unit(c), sparse::slot_of(J, c, 21 + c));
  const auto expect_block = [&](BlockSlot slot, int i, int j) {
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) {
        const int row = 3 * i + a, column = 3 * j + b;
        EXPECT_EQ(slot.first + b * slot.stride + a, sparse::slot_of(K, row, column));
        const BlockSlot position = pattern.jacobian_position(slot, j);
        EXPECT_EQ(position.first + b * position.stride + a, sparse::slot_of(J, 21 + row, column));
        const BlockSlot velocity = pattern.jacobian_velocity(slot, j);
        EXPECT_EQ(velocity.first + b * velocity.stride + a, sparse::slot_of(J, 21 + row, 21 + column));
      }
    }
  };
  for (int i = 0; i < 7; ++i) expect_block(pattern.diagonal(i), i, i);
  const auto springs = static_cast<std::size_t>(
      std::find_if(cliques.begin(), cliques.end(), [](const Cliques& batch) { return batch.arity == 2; }) -
      cliques.begin());
  ASSERT_LT(springs, cliques.size());
  for (std::size_t e = 0; e < model.springs.size(); ++e) {
    const std::array<int, 2> nodes{model.springs.first[e], model.springs.second[e]};
    expect_block(pattern.slot(springs, e, 0, 1, nodes), nodes[0], nodes[1]);
    expect_block(pattern.slot(springs, e, 1, 0, nodes), nodes[1], nodes[0]);
  }
}

TEST(BlockPattern, StaysTheSameAndFillingTwiceGivesTheSameValues) {
  RandomModels random(20260602);
  const MassSpringSystem system(random.everything(SpringLaw::hooke));
  const State state = random.state(system.model()), other = random.state(system.model());
  SparseMatrix K = system.tangent_pattern(), D = K, J = system.jacobian_pattern();
  const SparseMatrix tangent = K, jacobian = J;
  system.stiffness(0.0, state.q, state.v, TangentModel::exact, K);
  system.damping(0.0, state.q, state.v, D);
  system.jacobian(0.0, state.stacked(), J);
  const Matrix first_K = K, first_D = D, first_J = J;
  system.stiffness(0.0, other.q, other.v, TangentModel::exact, K);
  system.damping(0.0, other.q, other.v, D);
  system.jacobian(0.0, other.stacked(), J);
  EXPECT_NE(Matrix(K), first_K);
  EXPECT_NE(Matrix(D), first_D);
  EXPECT_NE(Matrix(J), first_J);
  system.stiffness(0.0, state.q, state.v, TangentModel::exact, K);
  system.damping(0.0, state.q, state.v, D);
  system.jacobian(0.0, state.stacked(), J);
  EXPECT_EQ(Matrix(K), first_K);
  EXPECT_EQ(Matrix(D), first_D);
  EXPECT_EQ(Matrix(J), first_J);
  for (const SparseMatrix* matrix : {&K, &D}) {
    EXPECT_TRUE(same_structure(*matrix, tangent));
    EXPECT_TRUE(same_structure(*matrix, system.tangent_pattern()));
  }
  EXPECT_TRUE(same_structure(J, jacobian));
  EXPECT_TRUE(same_structure(J, system.jacobian_pattern()));
}

TEST(BlockPattern, IsSharedByThreadsThatAskForItAtOnce) {
  RandomModels random(20260603);
  const MassSpringSystem system(random.everything(SpringLaw::hooke));
  const Vector y = random.state(system.model()).stacked();
  std::vector<SparseMatrix> found(4);
  {
    std::vector<std::jthread> threads;
    for (SparseMatrix& J : found) {
      threads.emplace_back([&] {
        J = system.jacobian_pattern();
        system.jacobian(0.0, y, J);
      });
    }
  }
  for (const SparseMatrix& J : found) {
    EXPECT_TRUE(same_structure(J, found[0]));
    EXPECT_EQ(Matrix(J), Matrix(found[0]));
  }
}

TEST(BlockPattern, OfAnotherMatrixIsRefused) {
  RandomModels random(20260604);
  const MassSpringSystem system(random.everything(SpringLaw::hooke));
  const State state = random.state(system.model());
  SparseMatrix wrong_size(5, 5), empty(state.q.size(), state.q.size());
  EXPECT_THROW(system.stiffness(0.0, state.q, state.v, TangentModel::exact, wrong_size), InputError);
  EXPECT_THROW(system.damping(0.0, state.q, state.v, empty), InputError);
  SparseMatrix tangent = system.tangent_pattern();
  EXPECT_THROW(system.jacobian(0.0, state.stacked(), tangent), InputError);
}

TEST(BlockPattern, RefusesMoreEntriesThanItsIndicesCanCount) {
  // Two particles joined 60 million times would stay small, but the bound is taken before repetitions are
  // known.
  std::vector<Cliques> cliques = {{.arity = 2, .nodes = std::vector<int>(120'000'000, 0)}};
  EXPECT_THROW(BlockPattern(2, cliques), InputError);
}

}  // namespace
}  // namespace fw::mechanics
