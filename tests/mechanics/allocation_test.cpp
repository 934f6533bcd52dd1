#include <gtest/gtest.h>

#include "allocation_counter.hpp"
#include "random_model.hpp"

namespace fw::mechanics {
namespace {

TEST(Evaluation, AllocatesNothing) {
  EXPECT_GE(allocations_of([] { const std::vector<double> values(1000, 1.0); }), 1u);
  EXPECT_GE(allocations_of([] { const Vector values = Vector::Ones(1000); }), 1u);

  RandomModels random(20260701);
  for (const SpringLaw law : all_laws) {
    const MassSpringSystem system(random.everything(law));
    const State state = random.state(system.model());
    const Vector y = state.stacked(), w = random.vector(y.size(), 1.0);
    const Index n = state.q.size();
    Vector dydt(2 * n), product(2 * n), f(n), df(n);
    EXPECT_EQ(allocations_of([&] {
                system.force(0.0, state.q, state.v, f);
                system.rhs(0.0, y, dydt);
                system.jacobian_product(0.0, y, w, product);
                system.tangent_product(0.0, y.head(n), y.tail(n), w.head(n), w.tail(n), df);
                system.energies(state.q, state.v);
                system.dissipated_power(state.q, state.v);
              }),
              0u);
    SparseMatrix K = system.tangent_pattern(), D = K, J = system.jacobian_pattern();
    EXPECT_EQ(allocations_of([&] {
                system.stiffness(0.0, state.q, state.v, TangentModel::psd_projection, K);
                system.damping(0.0, state.q, state.v, D);
                system.jacobian(0.0, y, J);
              }),
              0u);
  }
}

TEST(Evaluation, AllocatesNothingForForcesOverTime) {
  RandomModels random(20261128);
  MassSpringModel model = random.everything(SpringLaw::hooke);
  const formula::VectorFunction wave(formula::ExpressionFunction{
      formula::Expression("sin(t)^2"), formula::Expression("exp(-t)"), formula::Expression("max(t, 1)")});
  const formula::VectorFunction table(formula::TableFunction{{0, 1}, {{0, 0, 0}, {1, 2, 3}}});
  model.forces = {{{0, 1}, wave}, {{2}, table}};
  model.support_motions = {{{0}, wave}};
  const MassSpringSystem system(model);
  const State state = random.state(system.model());
  const Vector y = state.stacked();
  Vector dydt(y.size()), f(y.size() / 2);
  EXPECT_EQ(allocations_of([&] {
              system.force(0.5, state.q, state.v, f);
              system.rhs(0.5, y, dydt);
              system.energies(0.5, state.q, state.v);
              system.dissipated_power(0.5, state.q, state.v);
              system.external_power(0.5, state.q, state.v);
            }),
            0u);
}

TEST(Construction, AllocatesAHandfulOfArraysAndNothingPerSpring) {
  RandomModels random(20260702);
  const auto cost = [&](int springs) {
    MassSpringModel model = random.network(SpringLaw::hooke, 1000, springs, true);
    return allocations_of([&] {
      const MassSpringSystem system(std::move(model));
      system.tangent_pattern();
    });
  };
  const std::size_t small = cost(100);
  EXPECT_EQ(cost(10000), small);
  EXPECT_LE(small, 40u);
}

}  // namespace
}  // namespace fw::mechanics
