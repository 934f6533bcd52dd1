#include "mechanics/elements/spring_force.hpp"

#include <gtest/gtest.h>

#include "random_model.hpp"

namespace fw::mechanics {
namespace {

// d = (3, 4, 0), L = 5, r = (0.6, 0.8, 0); w = (1, 2, 7), w·r = 2.2, damper 2·2.2 = 4.4.
constexpr Vec3<double> d{3.0, 4.0, 0.0};
constexpr Vec3<double> w{1.0, 2.0, 7.0};

void expect_along_d(const Vec3<double>& force, double magnitude) {
  EXPECT_NEAR(force.x, 0.6 * magnitude, 1e-14);
  EXPECT_NEAR(force.y, 0.8 * magnitude, 1e-14);
  EXPECT_EQ(force.z, 0.0);
}

TEST(SpringForce, HookeAgreesWithAHandCalculation) {
  std::uint64_t degenerate = 0;
  expect_along_d(spring_force<SpringLaw::hooke>({10.0, 2.0, 4.0}, d, w, degenerate), 10.0 * 1.0 + 4.4);
  expect_along_d(spring_force<SpringLaw::hooke>({10.0, 2.0, 6.0}, d, w, degenerate), -10.0 * 1.0 + 4.4);
  EXPECT_EQ(degenerate, 0u);
}

TEST(SpringForce, StrainAgreesWithAHandCalculation) {
  std::uint64_t degenerate = 0;
  expect_along_d(spring_force<SpringLaw::strain>({10.0, 2.0, 4.0}, d, w, degenerate), 10.0 / 4.0 + 4.4);
  EXPECT_EQ(degenerate, 0u);
}

TEST(SpringForce, TensionOnlyActsWhenStretchedAndKeepsTheDamperWhenSlack) {
  std::uint64_t degenerate = 0;
  expect_along_d(spring_force<SpringLaw::tension_only>({10.0, 2.0, 4.0}, d, w, degenerate), 14.4);
  expect_along_d(spring_force<SpringLaw::tension_only>({10.0, 2.0, 6.0}, d, w, degenerate), 4.4);
  EXPECT_EQ(degenerate, 0u);
}

TEST(SpringForce, StrainKeepsTheStiffnessOfARefinedChain) {
  // One spring of length 1 against two of length ½ in a row, both stretched by 10 %.
  std::uint64_t degenerate = 0;
  const Vec3<double> rest{};
  const auto whole =
      spring_force<SpringLaw::strain>({30.0, 0.0, 1.0}, Vec3<double>{1.1, 0.0, 0.0}, rest, degenerate);
  const auto half =
      spring_force<SpringLaw::strain>({30.0, 0.0, 0.5}, Vec3<double>{0.55, 0.0, 0.0}, rest, degenerate);
  EXPECT_NEAR(whole.x, 3.0, 1e-14);
  EXPECT_NEAR(half.x, whole.x, 1e-14);
}

TEST(SpringForce, IsEqualAndOppositeOnBothEnds) {
  RandomModels random(20260101);
  for (const SpringLaw law : all_laws) {
    const MassSpringSystem system(random.network(law, 2, 1, true));
    for (int trial = 0; trial < 50; ++trial) {
      const Vector f = force_of(system, random.state(system.model()));
      EXPECT_EQ(f.head(3), -f.tail(3));
      EXPECT_GT(f.norm(), 0.0);
    }
  }
}

TEST(SpringForce, OfAFreeNetworkHasNoResultantAndNoMoment) {
  RandomModels random(20260102);
  for (const SpringLaw law : all_laws) {
    const MassSpringSystem system(random.network(law, 12, 40, true));
    for (int trial = 0; trial < 50; ++trial) {
      const State state = random.state(system.model());
      const Vector f = force_of(system, state);
      Vec3<double> resultant, moment;
      for (Index i = 0; i < system.particle_count(); ++i) {
        resultant += load3(f.data(), i);
        moment += cross(load3(state.q.data(), i), load3(f.data(), i));
      }
      const double scale = f.cwiseAbs().sum();
      EXPECT_LE(norm(resultant), 1e-14 * scale);
      EXPECT_LE(norm(moment), 1e-14 * scale);
    }
  }
}

TEST(SpringForce, OfASystemIsWeightDragSpringsAndAnchors) {
  MassSpringModel model;
  model.mass = {2.0, 3.0};
  model.springs = {{0}, {1}, {10.0}, {2.0}, {4.0}, SpringLaw::hooke};
  model.gravity = {0.0, 0.0, -10.0};
  model.drag = 0.5;
  model.anchors = {{1, {3.0, 4.0, -1.0}, 7.0, 0.25}};
  const MassSpringSystem system(model);
  State state{Vector::Zero(6), Vector::Zero(6)};
  state.q << 0, 0, 0, 3, 4, 0;
  state.v << 0, 0, 0, 1, 2, 7;
  Vector expected(6);
  expected << 8.64, 11.52, -20.0,                                        // spring 14.4 r, weight
      -8.64 - 0.5 - 0.25, -11.52 - 1.0 - 0.5, -30.0 - 3.5 - 7.0 - 1.75;  // drag, anchor
  EXPECT_LE((force_of(system, state) - expected).cwiseAbs().maxCoeff(), 1e-13);
  Vector dydt(12);
  system.rhs(0.0, state.stacked(), dydt);
  EXPECT_EQ(dydt.head(6), state.v);
  EXPECT_NEAR(dydt[8], -10.0, 1e-14);
  EXPECT_NEAR(dydt[9], -9.39 / 3.0, 1e-14);
}

TEST(FixedParticles, HaveNoForceNoSlopeAndNoRows) {
  RandomModels random(20260103);
  for (const SpringLaw law : all_laws) {
    const MassSpringSystem system(random.everything(law));
    State state = random.state(system.model());
    state.v.segment<3>(6).setConstant(3.0);  // even if a state says that it moves
    const Vector y = state.stacked();
    const Vector f = force_of(system, state);
    Vector dydt(y.size()), product(y.size());
    system.rhs(0.0, y, dydt);
    system.jacobian_product(0.0, y, random.vector(y.size(), 1.0), product);
    SparseMatrix J = system.jacobian_pattern();
    system.jacobian(0.0, y, J);
    const Matrix dense = J;
    const Matrix K = dense_stiffness(system, state), D = dense_damping(system, state);
    const Index n = f.size();
    for (Index c = 0; c < n; ++c) {
      const bool fixed = c / 3 == 2 || c / 3 == 5;
      EXPECT_EQ(system.fixed()[static_cast<std::size_t>(c)] != 0, fixed);
      EXPECT_EQ(f[c] == 0.0, fixed);
      EXPECT_EQ(dydt[c] == 0.0 && dydt[n + c] == 0.0, fixed);
      EXPECT_EQ(product[c] == 0.0 && product[n + c] == 0.0, fixed);
      EXPECT_EQ(dense.row(c).isZero(0.0) && dense.row(n + c).isZero(0.0), fixed);
      EXPECT_EQ(K.row(c).isZero(0.0) && D.row(c).isZero(0.0), fixed);
    }
  }
}

TEST(ForceClass, IsPositionOnlyWithoutAnyDamping) {
  RandomModels random(20260104);
  MassSpringModel model = random.everything(SpringLaw::hooke);
  for (double& damping : model.springs.damping) damping = 0.0;
  for (Anchor& anchor : model.anchors) anchor.damping = 0.0;
  for (Obstacle& obstacle : model.obstacles) obstacle.damping = 0.0;
  model.drag = 0.0;
  EXPECT_EQ(MassSpringSystem(model).force_class(), ForceClass::position);
  const auto class_with = [&](auto change) {
    MassSpringModel changed = model;
    change(changed);
    return MassSpringSystem(changed).force_class();
  };
  EXPECT_EQ(class_with([](auto& m) { m.springs.damping[3] = 0.1; }), ForceClass::velocity);
  EXPECT_EQ(class_with([](auto& m) { m.drag = 0.1; }), ForceClass::velocity);
  EXPECT_EQ(class_with([](auto& m) { m.anchors[1].damping = 0.1; }), ForceClass::velocity);
  EXPECT_EQ(class_with([](auto& m) { m.obstacles[2].damping = 0.1; }), ForceClass::velocity);
}

TEST(Precisions, AgreeInBinary128DoubleAndComplex) {
  RandomModels random(20260105);
  for (const SpringLaw law : all_laws) {
    const MassSpringSystem system(random.everything(law));
    for (int trial = 0; trial < 50; ++trial) {
      const Vector y = random.state(system.model()).stacked();
      Vector slope(y.size());
      system.rhs(0.0, y, slope);
      const std::vector<Float128> wide(y.begin(), y.end());
      std::vector<Float128> wide_slope(wide.size());
      system.rhs(Float128(0), std::span<const Float128>(wide), std::span<Float128>(wide_slope));
      const std::vector<Complex> complex(y.begin(), y.end());
      std::vector<Complex> complex_slope(complex.size());
      system.rhs(0.0, std::span<const Complex>(complex), std::span<Complex>(complex_slope));
      const double scale = slope.cwiseAbs().maxCoeff();
      for (Index c = 0; c < y.size(); ++c) {
        const auto k = static_cast<std::size_t>(c);
        EXPECT_LE(std::abs(static_cast<double>(wide_slope[k] - slope[c])), 2e-15 * scale);
        EXPECT_LE(std::abs(complex_slope[k] - slope[c]), 2e-15 * scale);
      }
      // Not merely double in a wider type: the exact sum differs in the digits behind.
      EXPECT_NE(static_cast<double>(wide_slope.back() - Float128(static_cast<double>(wide_slope.back()))),
                0.0);
    }
  }
}

}  // namespace
}  // namespace fw::mechanics
