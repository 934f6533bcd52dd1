#include <gtest/gtest.h>

#include <chrono>

#include "random_model.hpp"

namespace fw::mechanics {
namespace {

/// Side × side particles 1 cm apart with structural, shear and bending springs, one corner fixed.
MassSpringModel cloth(int side) {
  MassSpringModel model;
  model.mass.assign(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), 1e-4);
  model.gravity = {0.0, 0.0, -9.81};
  model.drag = 1e-6;
  model.fixed = {0};
  Springs& springs = model.springs;
  constexpr int offsets[][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}, {2, 0}, {0, 2}};
  springs.first.reserve(6 * model.mass.size());
  springs.second.reserve(6 * model.mass.size());
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      for (const auto& [down, right] : offsets) {
        const int r = row + down, c = column + right;
        if (r >= side || c < 0 || c >= side) continue;
        springs.first.push_back(row * side + column);
        springs.second.push_back(r * side + c);
      }
    }
  }
  springs.stiffness.assign(springs.size(), 50.0);
  springs.damping.assign(springs.size(), 0.01);
  springs.rest_length.assign(springs.size(), 0.012);
  return model;
}

State rippled(int side) {
  const Index n = 3 * static_cast<Index>(side) * side;
  RandomModels random(20260801);
  State state{random.vector(n, 1e-3), random.vector(n, 0.1)};
  for (Index i = 0; i < n / 3; ++i) {
    state.q[3 * i] += 0.01 * static_cast<double>(i % side);
    state.q[3 * i + 1] += 0.01 * static_cast<double>(i / side);
  }
  state.v.head(3).setZero();
  return state;
}

double seconds_of(const auto& action) {
  const auto start = std::chrono::steady_clock::now();
  action();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void record(const char* name, double seconds) {
  testing::Test::RecordProperty(name, std::to_string(seconds));
  std::printf("%s: %.3f s\n", name, seconds);
}

TEST(LargeCloth, OfAMillionParticlesIsEvaluatedAndDifferentiatedWithoutAMatrix) {
  constexpr int side = 1000;
  MassSpringModel model = cloth(side);
  EXPECT_GT(model.springs.size(), 5'980'000u);
  std::unique_ptr<MassSpringSystem> system;
  record("construction", seconds_of([&] { system = std::make_unique<MassSpringSystem>(std::move(model)); }));
  const Vector y = rippled(side).stacked();
  const Vector w = RandomModels(20260802).vector(y.size(), 1.0);
  Vector dydt(y.size()), product(y.size());
  record("right-hand side", seconds_of([&] { system->rhs(0.0, y, dydt); }));
  record("Jacobian product", seconds_of([&] { system->jacobian_product(0.0, y, w, product); }));
  EXPECT_TRUE(dydt.allFinite());

  std::vector<Complex> step(static_cast<std::size_t>(y.size())), slope(step.size());
  for (Index c = 0; c < y.size(); ++c) step[static_cast<std::size_t>(c)] = {y[c], 1e-200 * w[c]};
  system->rhs(0.0, std::span<const Complex>(step), std::span<Complex>(slope));
  double deviation = 0.0;
  for (Index c = 0; c < y.size(); ++c) {
    deviation =
        std::max(deviation, std::abs(slope[static_cast<std::size_t>(c)].imag() / 1e-200 - product[c]));
  }
  EXPECT_LE(deviation, 1e-12 * product.cwiseAbs().maxCoeff());
}

TEST(LargeCloth, AssembledAgreesWithItsProduct) {
  constexpr int side = 300;
  const MassSpringSystem system(cloth(side));
  const State state = rippled(side);
  const Vector y = state.stacked();
  const Vector w = RandomModels(20260803).vector(y.size(), 1.0);
  SparseMatrix J;
  record("pattern", seconds_of([&] { J = system.jacobian_pattern(); }));
  record("fill", seconds_of([&] { system.jacobian(0.0, y, J); }));
  Vector product(y.size());
  system.jacobian_product(0.0, y, w, product);
  EXPECT_LE((J * w - product).cwiseAbs().maxCoeff(), 1e-14 * product.cwiseAbs().maxCoeff());
}

}  // namespace
}  // namespace fw::mechanics
