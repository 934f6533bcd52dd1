#include "mechanics/assembly/energy.hpp"

#include <gtest/gtest.h>

#include "random_model.hpp"

namespace fw::mechanics {
namespace {

constexpr double h = 1e-200;

template <class Scalar>
Scalar potential_energy(const MassSpringModel& model, const Scalar* q) {
  Scalar sum(0);
  for (const ElementBatch& batch : elements_of<ElementBatch>(model)) {
    std::visit([&](const auto& elements) { add_energy(elements, q, sum); }, batch);
  }
  return sum;
}

/// ∇V·direction by a complex step.
double potential_slope(const MassSpringModel& model, const Vector& q, const Vector& direction) {
  std::vector<Complex> state(static_cast<std::size_t>(q.size()));
  for (Index c = 0; c < q.size(); ++c) state[static_cast<std::size_t>(c)] = {q[c], h * direction[c]};
  return potential_energy(model, state.data()).imag() / h;
}

/// The largest residual of dE/dt + P = 0 relative to the largest power at work, over random states.
template <class Change>
double power_imbalance(std::uint64_t seed, Change change_power) {
  RandomModels random(seed);
  double worst = 0.0;
  for (const SpringLaw law : all_laws) {
    for (int trial = 0; trial < 50; ++trial) {
      const MassSpringSystem system(trial % 2 == 0 ? random.everything(law) : random.everything_in_groups());
      const State state = random.state(system.model());
      const double kinetic_slope = force_of(system, state).dot(state.v);  // d/dt ½ Σ m v² = F·v
      const double slope = potential_slope(system.model(), state.q, state.v);
      const double power = change_power(system.dissipated_power(state.q, state.v));
      const double scale = std::abs(kinetic_slope) + std::abs(slope) + std::abs(power);
      worst = std::max(worst, std::abs(kinetic_slope + slope + power) / scale);
    }
  }
  return worst;
}

TEST(Energy, FallsByExactlyTheDissipatedPower) {
  EXPECT_LE(power_imbalance(20260401, [](double power) { return power; }), 1e-13);
}

TEST(Energy, BalanceNoticesAPowerThatIsOffByAPerMille) {
  EXPECT_GE(power_imbalance(20260401, [](double power) { return 1.001 * power; }), 1e-5);
}

TEST(Energy, OfAHandMadeStateIsTheSumOfItsParts) {
  MassSpringModel model;
  model.mass = {2.0, 3.0};
  model.springs = {{0}, {1}, {10.0}, {2.0}, {4.0}, SpringLaw::hooke};
  model.gravity = {0.0, 0.0, -10.0};
  model.drag = 0.5;
  model.anchors = {{1, {3.0, 4.0, -2.0}, 7.0, 0.25}};
  model.obstacles = {{Plane{{0.0, 0.0, 0.5}, {0.0, 0.0, 1.0}}, 16.0, 1.0}};
  const MassSpringSystem system(model);
  State state{Vector::Zero(6), Vector::Zero(6)};
  state.q << 0, 0, 1, 3, 4, 0;  // L² = 26
  state.v << 0, 0, 2, 1, 0, 0;
  const Energies energies = system.energies(state.q, state.v);
  const double stretch = std::sqrt(26.0) - 4.0;
  EXPECT_NEAR(energies["kinetic"], 4.0 + 1.5, 1e-14);
  EXPECT_NEAR(energies["elastic"], 5.0 * stretch * stretch + 3.5 * 4.0, 1e-13);
  EXPECT_NEAR(energies["gravitational"], 20.0, 1e-13);
  EXPECT_NEAR(energies["obstacle"], 8.0 * 0.25, 1e-14);
  EXPECT_NEAR(energies.total(), energies.kinetic() + energies.potential(), 1e-13);
  // d = (3, 4, −1), w = (1, 0, −2): w·r = 5/√26; the contact slides (v·n = 0); drag on both, anchor on 1.
  EXPECT_NEAR(system.dissipated_power(state.q, state.v), 2.0 * 25.0 / 26.0 + 0.5 * 5.0 + 0.25, 1e-13);
  const Vec3<double> p = system.linear_momentum(state.v);
  EXPECT_EQ(p, (Vec3<double>{3.0, 0.0, 4.0}));
  // (0, 0, 1) × (0, 0, 4) + (3, 4, 0) × (3, 0, 0).
  EXPECT_EQ(system.angular_momentum(state.q, state.v), (Vec3<double>{0.0, 0.0, -12.0}));
}

TEST(Energy, OfARopeIsZeroWhileItIsSlack) {
  const SpringParameters rope{10.0, 0.0, 2.0};
  EXPECT_EQ(spring_energy<SpringLaw::tension_only>(rope, 1.9), 0.0);
  EXPECT_NEAR(spring_energy<SpringLaw::tension_only>(rope, 2.5), 1.25, 1e-15);
  EXPECT_NEAR(spring_energy<SpringLaw::hooke>(rope, 1.5), 1.25, 1e-15);
  EXPECT_NEAR(spring_energy<SpringLaw::strain>(rope, 1.5), 0.625, 1e-15);
}

TEST(Energy, HasTheRestingForceAsItsNegativeGradient) {
  RandomModels random(20260402);
  for (const SpringLaw law : all_laws) {
    for (int trial = 0; trial < 50; ++trial) {
      MassSpringModel model = random.everything(law);
      model.fixed.clear();
      State state = random.state(model);
      state.v.setZero();
      const Vector f = force_of(MassSpringSystem(model), state);
      Vector gradient(f.size());
      for (Index c = 0; c < f.size(); ++c) {
        gradient[c] = potential_slope(model, state.q, Vector::Unit(f.size(), c));
      }
      EXPECT_LE(relative_deviation(-gradient, f), 1e-13);
    }
  }
}

TEST(Energy, IsTheSameInBinary128) {
  RandomModels random(20260403);
  for (const SpringLaw law : all_laws) {
    const MassSpringModel model = random.everything(law);
    const State state = random.state(model);
    const std::vector<Float128> q(state.q.begin(), state.q.end());
    const double narrow = potential_energy(model, state.q.data());
    EXPECT_NEAR(static_cast<double>(potential_energy(model, q.data())), narrow,
                1e-14 * std::abs(narrow) + 1e-13);
  }
}

TEST(DissipatedPower, IsNeverNegativeEvenWhereAContactIsClamped) {
  RandomModels random(20260404);
  int clamped = 0, pressing = 0;
  for (int trial = 0; trial < 300; ++trial) {
    MassSpringModel model;
    model.mass = {1.0};
    model.obstacles = {{Sphere{{}, 1.5}, 20.0, 15.0}};
    const MassSpringSystem system(model);
    const State state = random.state(model);
    const double power = system.dissipated_power(state.q, state.v);
    EXPECT_GE(power, 0.0);
    if (system.energies(state.q, state.v)["obstacle"] == 0.0) continue;
    const double force = force_of(system, state).norm();
    ++(force > 0.0 ? pressing : clamped);
    const double balance =
        force_of(system, state).dot(state.v) + potential_slope(model, state.q, state.v) + power;
    EXPECT_LE(std::abs(balance), 1e-12 * (power + 20.0));
  }
  EXPECT_GT(clamped, 20);
  EXPECT_GT(pressing, 20);
}

}  // namespace
}  // namespace fw::mechanics
