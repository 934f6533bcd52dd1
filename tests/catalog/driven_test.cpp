#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "analysis/reference/reference_solution.hpp"
#include "catalog/methods.hpp"
#include "mechanics/mass_spring_system.hpp"
#include "ode/not_applicable.hpp"
#include "scene/scene.hpp"
#include "study/measure/energy_gauge.hpp"

namespace fw::catalog {
namespace {

using testing::HasSubstr;

/// q̈ = −ω² q + a cos νt along x with ω = 2, ν = 3, a = 1.5 from q = 1, v = 0.5: a spring of length zero.
const char* forced_oscillator = R"toml(
[particles]
position = [[0, 0, 0], [1, 0, 0]]
velocity = [[0, 0, 0], [0.5, 0, 0]]
mass = 1.0
fixed = [0]
[springs]
between = [[0, 1]]
stiffness = 4.0
rest_length = 0.0
[[force]]
particle = 1
expression = ["1.5*cos(3*t)", "0", "0"]
)toml";

double closed_form(double t) {
  const double amplitude = 1.5 / (4.0 - 9.0);
  return (1.0 - amplitude) * std::cos(2.0 * t) + 0.25 * std::sin(2.0 * t) + amplitude * std::cos(3.0 * t);
}

/// Supports and a force over time, with dampers: along x, and a spring that turns in the plane.
const char* moved_supports = R"toml(
[world]
rayleigh = { mass = 0.25, stiffness = 0.01 }
[particles]
position = [[0, 0, 0], [1, 0, 0], [2, 0.5, 0]]
mass = [1.0, 0.5, 1.0]
[springs]
between = [[0, 1], [1, 2]]
stiffness = [12.0, 6.0]
damping = 0.25
[[anchor]]
particle = [0, 2]
stiffness = 8.0
damping = 0.5
expression = ["0.2*sin(3*t)", "0.1*t^2", "0"]
[[force]]
particle = 1
expression = ["0", "exp(-t)", "sin(2*t)"]
)toml";

Ivp ivp_of(const char* text, double end) {
  return scene::make_ivp(scene::parse_scene(text, "a.toml"), end);
}

struct Ended {
  double error = 0.0;
  bool is_refused = false;
};

/// ‖x − expected‖ at the end.
Ended end_error(const Integrator& method, const Ivp& ivp, const StepControl& control,
                const Vector& expected) {
  NullObserver observer;
  try {
    const Solution solution = method.solve(ivp, control, observer);
    EXPECT_TRUE(solution.status.ok()) << method.info().name << ": " << solution.status.describe();
    return {(solution.state.head(expected.size()) - expected).norm(), false};
  } catch (const NotApplicable& error) {
    EXPECT_THAT(error.what(), HasSubstr("expected"));
    return {0.0, true};
  }
}

/// Every method of the catalogue converges with its order to `expected`, or refuses.
void expect_orders(const Ivp& ivp, const Vector& expected, const std::vector<std::string>& refusing) {
  std::vector<std::string> refused;
  int count = 0;
  for (const MethodEntry& entry : methods()) {
    const auto method = make_method(entry.name);
    const MethodInfo& info = method->info();
    if (!why_not_applicable(info, *ivp.system).empty()) continue;
    ++count;
    if (info.is_adaptive) {
      const int order = order_on(info, *ivp.system);
      const double tolerance = order <= 2 ? 1e-4 : 1e-6;
      const Ended end =
          end_error(*method, ivp,
                    AdaptiveStep{.relative_tolerance = tolerance, .absolute_tolerance = tolerance}, expected);
      EXPECT_LT(end.error, 300.0 * tolerance) << info.name << " with tolerances";
    }
    if (!info.has_fixed_step) continue;
    const Ended coarse = end_error(*method, ivp, FixedStep{.step = 1.0 / 32.0}, expected);
    if (coarse.is_refused) {
      refused.push_back(entry.name);
      continue;
    }
    // Where two terms of the error cancel in part, the order shows at smaller steps only.
    double error = coarse.error, order = 0.0;
    for (double step = 1.0 / 64.0; step > 1e-3 && error > 1e-10; step /= 2.0) {
      const double finer = end_error(*method, ivp, FixedStep{.step = step}, expected).error;
      order = std::log2(error / finer);
      error = finer;
      if (order > order_on(info, *ivp.system) - 0.3) break;
    }
    EXPECT_LT(error, 0.1) << info.name;
    EXPECT_TRUE(error <= 1e-10 || order > order_on(info, *ivp.system) - 0.3)
        << info.name << ": order " << order << ", error " << error;
  }
  EXPECT_GT(count, 80);
  EXPECT_EQ(refused, refusing);
}

TEST(Driven, EveryMethodFollowsAForcedOscillator) {
  const double end = 1.75;
  Vector expected = Vector::Zero(6);
  expected[3] = closed_form(end);
  expect_orders(ivp_of(forced_oscillator, end), expected, {});
}

TEST(Driven, EveryMethodFollowsSupportsThatMove) {
  const Ivp ivp = ivp_of(moved_supports, 1.0);
  NullObserver observer;
  const Solution reference =
      make_method("dormand_prince_853")
          ->solve(ivp, AdaptiveStep{.relative_tolerance = 1e-13, .absolute_tolerance = 1e-13}, observer);
  expect_orders(ivp, reference.state.head(9), {"xpbd"});
}

TEST(Driven, TheEnergyWatchCountsWorkFromOutside) {
  // At rest, driven in resonance: all energy comes from outside, the amplitude is t/4 · 3.
  const Ivp resonance = ivp_of(R"toml(
[particles]
position = [[0, 0, 0], [0, 0, 0]]
mass = 1.0
fixed = [0]
[springs]
between = [[0, 1]]
stiffness = 4.0
rest_length = 0.0
[[force]]
particle = 1
expression = ["3*sin(2*t)", "0", "0"]
)toml",
                               20.0);
  const auto& system = dynamic_cast<const mechanics::MassSpringSystem&>(*resonance.system);
  const auto judged = [&](const char* method, const StepControl& control) {
    NullObserver observer;
    study::EnergyWatch watch(study::EnergyGauge(system), observer);
    const Solution solution = make_method(method)->solve(resonance, control, watch);
    EXPECT_TRUE(solution.status.ok() || solution.status.code == StatusCode::blow_up);
    return watch.judged(solution.status).code;
  };
  EXPECT_EQ(judged("velocity_verlet", FixedStep{.step = 0.01}), StatusCode::success);
  EXPECT_EQ(judged("velocity_verlet", FixedStep{.step = 0.5}), StatusCode::success);
  EXPECT_EQ(judged("sundials:cvode_bdf", AdaptiveStep{}), StatusCode::success);
  // h ω > 2: the method's own doing.
  EXPECT_EQ(judged("velocity_verlet", FixedStep{.step = 1.25}), StatusCode::blow_up);
}

/// A pulse by a table, m = 1: v rises to ½, x = ∫∫ in closed form.
TEST(Driven, StepsEndAtTheCornersOfATable) {
  const Ivp pulse = ivp_of(R"toml(
[particles]
position = [[0, 0, 0]]
mass = 1.0
[[force]]
particle = 0
table = { t = [5.0, 5.001, 5.002], value = [[0, 0, 0], [500, 0, 0], [0, 0, 0]] }
)toml",
                           10.0);
  const double expected = 0.5 * (10.0 - 5.001);
  const auto end = [&](const char* name, bool cut) {
    NullObserver observer;
    const Solution solution =
        make_method(name)->solve(pulse, AdaptiveStep{.relative_tolerance = 1e-8, .absolute_tolerance = 1e-8},
                                 observer, {.cut_at_switches = cut});
    EXPECT_TRUE(solution.status.ok()) << solution.status.describe();
    return solution.state[0];
  };
  for (const char* name :
       {"dormand_prince_54", "dormand_prince_853", "sundials:cvode_adams", "petsc:ts_rk"}) {
    EXPECT_NEAR(end(name, true), expected, 1e-6) << name;
  }
  EXPECT_NEAR(end("dormand_prince_54", false), 0.0, 1e-6);  // the pulse is not seen
  const analysis::ReferenceSolution reference = analysis::certified_reference(pulse, 10.0);
  ASSERT_TRUE(reference.status.ok()) << reference.status.describe();
  EXPECT_NEAR(static_cast<double>(reference.states.back().value[0]), expected, 1e-12);
  EXPECT_LT(reference.states.back().largest_error(), 1e-15);
}

}  // namespace
}  // namespace fw::catalog
