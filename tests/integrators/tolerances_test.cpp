#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "integrators/loop/step_size_controller.hpp"
#include "integrators/tableau/explicit_runge_kutta.hpp"
#include "network.hpp"
#include "problems/oscillators.hpp"
#include "schemes/explicit_tableaus.hpp"

namespace fw::integrators {
namespace {

TEST(Tolerances, ThatMakeNoSenseAreRefused) {
  NullObserver nobody;
  const Ivp ivp = problems::harmonic_oscillator().ivp;
  const auto scheme = make_explicit_runge_kutta(named(schemes::explicit_tableaus(), "dormand_prince_54"));
  const double nan = std::nan("");
  const std::vector<AdaptiveStep> bad = {
      {.relative_tolerance = 0.0},
      {.relative_tolerance = nan},
      {.absolute_tolerance = -1.0},
      {.absolute_velocity_tolerance = -1.0},
      {.absolute_velocity_tolerance = nan},
      {.initial_step = -1.0},
      {.initial_step = nan},
      {.minimum_step = -1.0},
      {.minimum_step = 1.0, .maximum_step = 0.5},
      {.initial_step = 0.1, .minimum_step = 0.2},
  };
  for (const AdaptiveStep& control : bad) EXPECT_THROW(scheme->solve(ivp, control, nobody), InputError);
  const auto fixed = make_explicit_runge_kutta(named(schemes::explicit_tableaus(), "rk4"));
  EXPECT_THROW(fixed->solve(ivp, AdaptiveStep{}, nobody), InputError);
}

TEST(Tolerances, OfVelocitiesAreThoseOfTheSecondHalf) {
  const Ivp ivp = problems::harmonic_oscillator().ivp;
  const AdaptiveStep both{.absolute_tolerance = 1e-3, .absolute_velocity_tolerance = 1e-6};
  EXPECT_EQ(absolute_tolerances(both, *ivp.system), (Vector{{1e-3, 1e-6}}));
  EXPECT_EQ(absolute_tolerances({.absolute_tolerance = 1e-3}, *ivp.system), (Vector{{1e-3, 1e-3}}));
}

/// Against the formulas, for two particles of which one errs.
TEST(Tolerances, BecomeANormOfTheError) {
  const Vector y = Vector::LinSpaced(12, -1.0, 1.2), y_new = 0.9 * y;
  Vector error = Vector::Zero(12);
  error[3] = 1e-4;   // of the position of the second
  error[10] = 2e-4;  // of its velocity
  for (const double of_velocities : {0.0, 1e-2}) {
    const AdaptiveStep control{
        .relative_tolerance = 1e-3, .absolute_tolerance = 1e-5, .absolute_velocity_tolerance = of_velocities};
    const double a = 1e-4 / (1e-5 + 1e-3 * std::abs(y[3]));
    const double b = 2e-4 / ((of_velocities > 0.0 ? of_velocities : 1e-5) + 1e-3 * std::abs(y[10]));
    const auto norm = [&](ErrorNorm kind) { return error_in_tolerances(kind, control, error, y, y_new); };
    EXPECT_NEAR(norm(ErrorNorm::largest_particle), std::sqrt((a * a + b * b) / 6.0), 1e-12);
    EXPECT_NEAR(norm(ErrorNorm::root_mean_square), std::sqrt((a * a + b * b) / 12.0), 1e-12);
    EXPECT_NEAR(norm(ErrorNorm::maximum), std::max(a, b), 1e-12);
  }
  // A component that is not finite is never within a tolerance, whichever particle has it.
  for (const Index place : {0, 5, 6, 11}) {
    Vector bad = error;
    bad[place] = std::nan("");
    for (const ErrorNorm kind :
         {ErrorNorm::largest_particle, ErrorNorm::root_mean_square, ErrorNorm::maximum}) {
      EXPECT_FALSE(error_in_tolerances(kind, {}, bad, y, y_new) <= 1.0) << place;
    }
  }
}

}  // namespace
}  // namespace fw::integrators
