#include "mechanics/elements/obstacle_force.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "mechanics/elements/obstacle_tangent.hpp"
#include "random_model.hpp"

namespace fw::mechanics {
namespace {

using Point = Vec3<double>;

template <class Shape>
Point penalty(const Shape& shape, const Point& x, const Point& v) {
  return obstacle_force(Obstacle{shape, 10.0, 2.0}, shape, x, v);
}

TEST(Obstacle, PlanePushesAlongItsNormalByDepthAndApproachSpeed) {
  const Plane plane{{0.0, 0.0, 1.0}, {0.0, 0.6, 0.8}};
  // (0, 0, −1) is 2 below along z: δ = 2·0.8 = 1.6; v·n = −1·0.8, f = 16 + 1.6.
  const Point f = penalty(plane, {0.0, 0.0, -1.0}, {5.0, 0.0, -1.0});
  EXPECT_EQ(f.x, 0.0);
  EXPECT_NEAR(f.y, 17.6 * 0.6, 1e-13);
  EXPECT_NEAR(f.z, 17.6 * 0.8, 1e-13);
  EXPECT_EQ(penalty(plane, {0.0, 0.0, 1.1}, {0.0, 0.0, -50.0}), Point{});
}

TEST(Obstacle, SpherePushesAwayFromItsCentre) {
  const Sphere sphere{{1.0, 0.0, 0.0}, 2.0};
  const Point f = penalty(sphere, {1.0, 1.5, 0.0}, {3.0, -1.0, 0.0});  // δ = ½, v·n = −1
  EXPECT_EQ(f.x, 0.0);
  EXPECT_NEAR(f.y, 5.0 + 2.0, 1e-13);
  EXPECT_EQ(f.z, 0.0);
  EXPECT_EQ(penalty(sphere, {1.0, 2.5, 0.0}, {0.0, -9.0, 0.0}), Point{});
}

TEST(Obstacle, BoxPushesOutThroughTheNearestFace) {
  const Box box{{0.0, 0.0, 0.0}, {4.0, 6.0, 8.0}};
  const Point rest{};
  EXPECT_EQ(penalty(box, {0.5, 3.0, 4.0}, rest), (Point{-5.0, 0.0, 0.0}));
  EXPECT_EQ(penalty(box, {3.5, 3.0, 4.0}, rest), (Point{5.0, 0.0, 0.0}));
  EXPECT_EQ(penalty(box, {2.0, 0.5, 4.0}, rest), (Point{0.0, -5.0, 0.0}));
  EXPECT_EQ(penalty(box, {2.0, 5.5, 4.0}, rest), (Point{0.0, 5.0, 0.0}));
  EXPECT_EQ(penalty(box, {2.0, 3.0, 0.5}, rest), (Point{0.0, 0.0, -5.0}));
  EXPECT_EQ(penalty(box, {2.0, 3.0, 7.5}, rest), (Point{0.0, 0.0, 5.0}));
  EXPECT_EQ(penalty(box, {2.0, 3.0, 8.5}, rest), Point{});
  EXPECT_EQ(penalty(box, {-0.5, 3.0, 4.0}, rest), Point{});
}

TEST(Obstacle, NeverPulls) {
  const Plane plane{{}, {0.0, 0.0, 1.0}};
  const Point below{0.0, 0.0, -0.1};  // k δ = 1, clamped for v·n ≥ ½
  EXPECT_NEAR(penalty(plane, below, {0.0, 0.0, 0.4}).z, 0.2, 1e-15);
  EXPECT_EQ(penalty(plane, below, {0.0, 0.0, 0.6}), Point{});
  const Obstacle obstacle{plane, 10.0, 2.0};
  const auto clamped = obstacle_tangent(obstacle, plane, below, {0.0, 0.0, 0.6}, TangentModel::exact);
  EXPECT_TRUE(clamped.position_block().isZero(0.0));
  EXPECT_TRUE(clamped.velocity_block().isZero(0.0));
}

TEST(Obstacle, HasADirectionAtTheCentreOfASphereAndOnTheRidgesOfABox) {
  const Sphere sphere{{1.0, 2.0, 3.0}, 2.0};
  EXPECT_EQ(penalty(sphere, {1.0, 2.0, 3.0}, {}), (Point{0.0, 0.0, 20.0}));
  const Box cube{{-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}};
  EXPECT_EQ(penalty(cube, {}, {}), (Point{-10.0, 0.0, 0.0}));
  EXPECT_EQ(penalty(cube, {0.0, 0.5, 0.5}, {}), (Point{0.0, 5.0, 0.0}));
  EXPECT_EQ(penalty(cube, {1.0, 1.0, 1.0}, {}), Point{});  // a corner is not inside
}

TEST(Obstacle, IsFiniteArbitrarilyNearTheCentreOfASphere) {
  const Sphere sphere{{}, 2.0};
  const Obstacle obstacle{sphere, 10.0, 2.0};
  for (const double x : {0.0, 5e-324, 1e-200, 1e-162, 1e-150, 1e-20}) {
    const Point at{x, 0.0, 0.0}, v{0.3, -0.2, 0.1};
    EXPECT_NEAR(norm(penalty(sphere, at, {})), 20.0, 20.0 * 0.5);
    const auto tangent = obstacle_tangent(obstacle, sphere, at, v, TangentModel::exact);
    EXPECT_TRUE(tangent.position_block().allFinite()) << x;
    EXPECT_TRUE(tangent.velocity_block().allFinite()) << x;
  }
}

TEST(Obstacle, TangentAtTheCentreOfASphereAgreesWithComplexSteps) {
  MassSpringModel model;
  model.mass = {1.0};
  model.obstacles = {{Sphere{{}, 2.0}, 10.0, 2.0}};
  State state{Vector::Zero(3), Vector::Zero(3)};
  state.v << 0.3, -0.2, 0.1;
  const MassSpringSystem system(model);
  const auto [K, D] = complex_step_tangents(model, state);
  EXPECT_LE(relative_deviation(dense_stiffness(system, state), K), 1e-14);
  EXPECT_LE(relative_deviation(dense_damping(system, state), D), 1e-14);
}

TEST(Obstacle, CheckOfTangentsCatchesAMissingCurvature) {
  RandomModels random(20260501);
  for (int trial = 0; trial < 50; ++trial) {
    MassSpringModel model;
    model.mass = {1.0};
    model.obstacles = {{Sphere{{}, 2.0}, 10.0, 0.0}};
    const State state = random.state(model);
    const auto K = complex_step_tangents(model, state).first;
    const MassSpringSystem system(model);
    EXPECT_LE(relative_deviation(dense_stiffness(system, state), K), 1e-12);
    // The projected block is the one without curvature.
    EXPECT_GE(relative_deviation(dense_stiffness(system, state, TangentModel::psd_projection), K), 1e-2);
  }
}

}  // namespace
}  // namespace fw::mechanics
