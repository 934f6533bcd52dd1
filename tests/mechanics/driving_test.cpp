#include "mechanics/driving.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"
#include "mechanics/mass_spring_system.hpp"

namespace fw::mechanics {
namespace {

using formula::Expression;
using formula::ExpressionFunction;
using formula::VectorFunction;
using testing::HasSubstr;

VectorFunction support_path() {
  return VectorFunction(
      ExpressionFunction{Expression("0.3*sin(2*t)"), Expression("t^2/5"), Expression("1-cos(t)")});
}

/// Three particles, the last one fixed; anchors on the first and the last one follow a path, a force pulls the
/// second and the last one.
MassSpringModel driven_model() {
  MassSpringModel model;
  model.mass = {1.0, 2.0, 3.0};
  model.fixed = {2};
  model.gravity = {0, 0, -9.81};
  model.drag = 0.125;
  model.mass_drag = 0.75;
  model.springs.add(0, 1, {.stiffness = 40.0, .damping = 0.5, .rest_length = 0.8});
  model.springs.add(1, 2, {.stiffness = 60.0, .damping = 0.25, .rest_length = 0.9});
  model.anchors = {{0, {0.1, 0, 0}, 30.0, 0.75}, {2, {2, 0, 0.25}, 20.0, 0.5}};
  model.support_motions = {{{0, 1}, support_path()}};
  model.forces = {
      {{1, 2}, VectorFunction(ExpressionFunction{Expression("cos(3*t)"), Expression("2"), Expression("t")})}};
  return model;
}

Vector driven_state() {
  Vector y = Vector::Zero(18);
  y.head(9) << 0.2, -0.1, 0.1, 1.1, 0.2, 0.0, 2.0, 0.0, 0.0;
  y.segment(9, 6) << 0.3, -0.4, 0.5, -0.2, 0.7, 0.1;
  return y;
}

TEST(Driving, IsTheForceOfASupportThatMoves) {
  const MassSpringModel model = driven_model();
  MassSpringModel still = model;
  still.support_motions.clear();
  still.forces.clear();
  const double t = 0.7;
  // The same anchors where they are at t, with the velocity of the supports in the dampers.
  for (Anchor& anchor : still.anchors) anchor.rest_position += support_path()(t).value;
  const MassSpringSystem driven(model), standing(still);
  const Vector y = driven_state();
  Vector f(9), g(9);
  driven.force(t, y.head(9), y.tail(9), f);
  standing.force(t, y.head(9), y.tail(9), g);
  const Vec3<double> rate = support_path()(t).rate;
  g.segment(0, 3) += 0.75 * Vector::Map(&rate.x, 3);
  g.segment(3, 3) += (Vector(3) << std::cos(3 * t), 2, t).finished();
  EXPECT_LT((f - g).lpNorm<Eigen::Infinity>(), 1e-13);
  EXPECT_EQ(f.tail(3), Vector::Zero(3));
  EXPECT_NEAR(driven.energies(t, y.head(9), y.tail(9)).total(),
              standing.energies(y.head(9), y.tail(9)).total(), 1e-12);
}

TEST(Driving, EveryArithmeticHasIt) {
  const MassSpringSystem system(driven_model());
  const Vector y = driven_state();
  const double t = 1.3;
  Vector expected(18);
  system.rhs(t, y, expected);
  std::vector<Float128> extended(y.begin(), y.end()), slope(18);
  system.rhs(Float128(t), extended, slope);
  std::vector<Complex> complex(y.begin(), y.end()), complex_slope(18);
  system.rhs(t, complex, complex_slope);
  for (std::size_t i = 0; i < 18; ++i) {
    EXPECT_NEAR(static_cast<double>(slope[i]), expected[static_cast<Index>(i)], 1e-12);
    EXPECT_NEAR(complex_slope[i].real(), expected[static_cast<Index>(i)], 1e-12);
  }
  const Float128 later = Float128(t) + Float128(1e-25);  // that a double does not see
  std::vector<Float128> moved(18);
  system.rhs(later, extended, moved);
  EXPECT_NE(moved[9], slope[9]);
}

/// d(T + V)/dt = P_ext − P_dissipated along the motion, by central differences of the energy.
TEST(Driving, PowersCloseTheBalance) {
  const MassSpringSystem system(driven_model());
  const Vector y = driven_state();
  for (const double t : {0.0, 0.4, 2.1}) {
    Vector slope(18);
    system.rhs(t, y, slope);
    const auto energy = [&](double delta) {
      const Vector moved = y + delta * slope;
      return system.energies(t + delta, moved.head(9), moved.tail(9)).total();
    };
    constexpr double delta = 1e-5;
    const double rate = (energy(delta) - energy(-delta)) / (2 * delta);
    const double outer = system.external_power(t, y.head(9), y.tail(9));
    const double lost = system.dissipated_power(t, y.head(9), y.tail(9));
    EXPECT_NEAR(rate, outer - lost, 1e-7) << t;
    EXPECT_GT(lost, 0.0);
    EXPECT_GT(std::abs(outer), 0.1);
  }
}

TEST(Driving, MassDragIsInTheTangent) {
  const MassSpringSystem system(driven_model());
  const Vector y = driven_state();
  SparseMatrix J = system.jacobian_pattern();
  system.jacobian(0.5, y, J);
  const double delta = 1e-6;
  Vector up(18), down(18);
  for (Index j = 9; j < 15; ++j) {
    system.rhs(0.5, Vector(y + delta * Vector::Unit(18, j)), up);
    system.rhs(0.5, Vector(y - delta * Vector::Unit(18, j)), down);
    EXPECT_LT((Vector(J.col(j)) - (up - down) / (2 * delta)).lpNorm<Eigen::Infinity>(), 1e-7) << j;
  }
}

TEST(Driving, ASplittingPutsItToTheSoftForces) {
  const MassSpringSystem system(driven_model());
  const Vector y = driven_state();
  Vector f(9), stiff(9), soft(9);
  system.force(0.9, y.head(9), y.tail(9), f);
  system.force_splitting()->stiff_force(0.9, y.head(9), y.tail(9), stiff);
  system.force_splitting()->soft_force(0.9, y.head(9), y.tail(9), soft);
  EXPECT_LT((f - stiff - soft).lpNorm<Eigen::Infinity>(), 1e-13);
}

template <class Scalar>
class Corners final : public SwitchSink<Scalar> {
 public:
  void add(const Switch<Scalar>& found) override { list.push_back(found); }
  std::vector<Switch<Scalar>> list;
};

TEST(Driving, CornersOfTablesAreSwitches) {
  MassSpringModel model = driven_model();
  model.forces = {{{1}, VectorFunction(formula::TableFunction{{0.5, 1.0}, {{0, 0, 0}, {4, 0, 0}}})}};
  const MassSpringSystem system(model);
  ASSERT_NE(system.switching_surfaces(), nullptr);
  EXPECT_FALSE(system.is_smooth());
  const Vector y = driven_state();
  const auto at = [&](double start, double length) {
    Corners<double> sink;
    system.switching_surfaces()->find({start, length, y.data(), y.data()}, sink);
    return sink.list;
  };
  EXPECT_TRUE(at(0.0, 0.25).empty());
  ASSERT_EQ(at(0.25, 0.5).size(), 1u);
  const Switch<double> found = at(0.25, 0.5).front();
  EXPECT_EQ(found.offset, 0.25);
  EXPECT_EQ(found.kind, "forces");
  EXPECT_EQ(found.nodes[0], 1);
  EXPECT_EQ(found.jump, 0.0);
  EXPECT_DOUBLE_EQ(found.rate, 8.0 / 2.0);
  EXPECT_EQ(found.to, found.at_end);
  EXPECT_NE(at(0.25, 2.0).front().to, at(0.25, 2.0).front().at_end);
  // It has been passed where a step begins, exactly or by rounding.
  EXPECT_TRUE(at(0.5, 0.25).empty());
  EXPECT_TRUE(at(std::nextafter(0.5, 0.0), 0.25).empty());
  EXPECT_TRUE(at(1.0, 5.0).empty());
  std::vector<Float128> extended(y.begin(), y.end());
  Corners<Float128> sink;
  system.switching_surfaces()->find({Float128(0.75), Float128(1), extended.data(), extended.data()}, sink);
  ASSERT_EQ(sink.list.size(), 1u);
  EXPECT_EQ(sink.list.front().offset, Float128(0.25));
}

TEST(Driving, NamesEntriesThatAreNotThere) {
  const auto message = [](const MassSpringModel& model) {
    try {
      const MassSpringSystem system(model);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  MassSpringModel model = driven_model();
  model.forces[0].particles = {3};
  EXPECT_THAT(message(model), HasSubstr("forces[0].particles: found 3"));
  model = driven_model();
  model.support_motions[0].anchors = {2};
  EXPECT_THAT(message(model), HasSubstr("support_motions[0].anchors: found 2"));
  model = driven_model();
  model.mass_drag = -1;
  EXPECT_THAT(message(model), HasSubstr("mass_drag: found -1"));
}

}  // namespace
}  // namespace fw::mechanics
