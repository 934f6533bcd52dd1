#include "study/measure/error_norms.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ode/functor_system.hpp"

namespace fw::study {
namespace {

/// y' = −y, which has no velocities.
struct Decay {
  template <class S>
  void operator()(const S&, std::span<const S> y, std::span<S> dydt) const {
    for (std::size_t i = 0; i < y.size(); ++i) dydt[i] = -y[i];
  }
};

/// Two free particles on a line, M q̈ = 0.
struct Free {
  template <class S>
  void operator()(const S&, std::span<const S>, std::span<const S>, std::span<S> f) const {
    for (S& each : f) each = S(0);
  }
};

Ivp first_order() {
  Ivp ivp;
  ivp.system = std::make_shared<const FunctorSystem<Decay>>(4, Decay{});
  ivp.y0 = Vector::Ones(4);
  return ivp;
}

Ivp second_order() {
  Ivp ivp;
  ivp.system = std::make_shared<const FunctorSecondOrderSystem<Free>>(Eigen::Vector2d(1.0, 1.0),
                                                                      ForceClass::position, Free{});
  ivp.y0 = Eigen::Vector4d(0.0, 1.0, 3.0, 4.0);
  return ivp;
}

analysis::ReferenceState reference(const Vector& value) {
  analysis::ReferenceState state;
  state.value.assign(value.data(), value.data() + value.size());
  return state;
}

TEST(ErrorNorms, RelateAFirstOrderStateToOneScale) {
  const Ivp ivp = first_order();
  const StateScale scale{.position = 100.0, .velocity = 200.0, .state = 4.0};
  const Vector difference = Eigen::Vector4d(2.0, -2.0, 2.0, 2.0);
  EXPECT_EQ(root_mean_square(difference), 2.0);
  EXPECT_EQ(root_mean_square(Vector()), 0.0);
  EXPECT_EQ(relative_norm(ivp, difference, scale), 0.5);
  EXPECT_EQ(smallest_scale(ivp, scale), 4.0);
}

TEST(ErrorNorms, RelatePositionsAndVelocitiesToTheirOwnScales) {
  const Ivp ivp = second_order();
  const StateScale scale{.position = 2.0, .velocity = 0.5, .state = 1e9};
  const Vector difference = Eigen::Vector4d(4.0, 4.0, 3.0, -3.0);  // 2 and 6 in units of the scales
  EXPECT_DOUBLE_EQ(relative_norm(ivp, difference, scale), std::sqrt(0.5 * (4.0 + 36.0)));
  EXPECT_EQ(smallest_scale(ivp, scale), 0.5);
}

TEST(ErrorNorms, MeasureTheDifferenceFromTheReference) {
  const Ivp ivp = second_order();
  const Vector end = Eigen::Vector4d(6.0, 9.0, 3.0, 4.0);
  const StateScale scale = measure_scale(ivp, reference(end));
  EXPECT_DOUBLE_EQ(scale.position, std::sqrt(0.5 * (36.0 + 64.0)));  // of the change from (0, 1)
  EXPECT_DOUBLE_EQ(scale.velocity, std::sqrt(0.5 * (9.0 + 16.0)));
  const Vector state = end + Eigen::Vector4d(0.5, 0.5, 0.25, -0.25);
  const StateError error = measure_error(ivp, state, reference(end), scale);
  EXPECT_EQ(error.position, 0.5);
  EXPECT_EQ(error.velocity, 0.25);
  EXPECT_EQ(error.relative, relative_norm(ivp, state - end, scale));
  EXPECT_EQ(error.components, (std::vector<double>{0.5, 0.5, 0.25, -0.25}));
}

}  // namespace
}  // namespace fw::study
