#include "ode/event_locator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "core/error.hpp"
#include "integrators/tableau/explicit_runge_kutta.hpp"
#include "ode/functor_system.hpp"
#include "schemes/explicit_tableaus.hpp"

namespace fw {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double gravity = 9.81;

std::unique_ptr<Integrator> method(const std::string& name) {
  const auto& tableaus = schemes::explicit_tableaus();
  const auto found = std::ranges::find(tableaus, name, &schemes::ButcherTableau::name);
  EXPECT_NE(found, tableaus.end()) << name;
  return integrators::make_explicit_runge_kutta(*found);
}

template <class Functor>
Ivp problem(const Functor& functor, Vector y0, double t1) {
  Ivp ivp;
  ivp.system = std::make_shared<FunctorSystem<Functor>>(y0.size(), functor);
  ivp.y0 = std::move(y0);
  ivp.t1 = t1;
  return ivp;
}

/// ÿ = −g.
struct FreeFall {
  template <class S>
  void operator()(const S&, std::span<const S> y, std::span<S> dydt) const {
    dydt[0] = y[1];
    dydt[1] = S(-gravity);
  }
};

/// φ̈ = −sin φ.
struct Pendulum {
  template <class S>
  void operator()(const S&, std::span<const S> y, std::span<S> dydt) const {
    using std::sin;
    dydt[0] = y[1];
    dydt[1] = -sin(y[0]);
  }
};

/// (cos t, −sin t).
struct Circle {
  template <class S>
  void operator()(const S&, std::span<const S> y, std::span<S> dydt) const {
    dydt[0] = y[1];
    dydt[1] = -y[0];
  }
};

EventFunction component(Index i, double level, EventDirection direction = EventDirection::both,
                        bool terminal = false) {
  return {"component", [=](double, ConstVectorRef y) { return y[i] - level; }, direction, terminal};
}

/// A clock: the solution does not matter.
EventFunction at_time(double time, bool terminal = false) {
  return {"clock", [=](double t, ConstVectorRef) { return t - time; }, EventDirection::both, terminal};
}

std::vector<Event> events_of(const Ivp& ivp, const StepControl& control, const std::string& name,
                             std::vector<EventFunction> functions, EventOptions options = {}) {
  NullObserver nobody;
  EventLocator locator(std::move(functions), nobody, options);
  const Solution solution = solve_with_events(*method(name), ivp, control, locator);
  EXPECT_EQ(solution.status.ok(), locator.terminal_event() == nullptr) << solution.status.describe();
  return locator.events();
}

TEST(EventLocator, FindsTheImpactOfAFallingBallInClosedForm) {
  const double height = 1.3, impact = std::sqrt(2.0 * height / gravity);
  const Ivp ivp = problem(FreeFall{}, Vector{{height, 0.0}}, 1.0);
  const EventFunction ground = component(0, 0.0, EventDirection::falling, true);
  for (const char* name : {"rk4", "dormand_prince_54", "heun3"}) {
    const EventOptions options{.time_tolerance = 1e-13};
    const std::vector<Event> events = events_of(ivp, FixedStep{.step = 0.09}, name, {ground}, options);
    ASSERT_EQ(events.size(), 1u) << name;
    EXPECT_NEAR(events[0].time, impact, 1e-13) << name;
    EXPECT_NEAR(events[0].state[1], -gravity * impact, 1e-12) << name;
    EXPECT_LE(events[0].state[0], 0.0)
        << name << ": on the far side, so that the next run does not meet it again";
  }
}

TEST(EventLocator, FollowsABouncingBallOverTenImpacts) {
  // Impacts at t₀ + 2 v₀/g (1 + e + e² + …) with v₀ = √(2 g h).
  const double height = 0.8, restitution = 0.7, first = std::sqrt(2.0 * height / gravity);
  Ivp ivp = problem(FreeFall{}, Vector{{height, 0.0}}, 100.0);
  double expected = first, flight = 2.0 * first;
  NullObserver nobody;
  EventLocator locator({component(0, 0.0, EventDirection::falling, true)}, nobody, {.time_tolerance = 1e-13});
  for (int impact = 0; impact < 10; ++impact) {
    const Solution solution =
        solve_with_events(*method("dormand_prince_54"), ivp, AdaptiveStep{.maximum_step = 0.02}, locator);
    ASSERT_EQ(solution.status.code, StatusCode::stopped_by_observer);
    EXPECT_NEAR(solution.time, expected, 1e-11) << "impact " << impact;
    ivp.t0 = solution.time;
    ivp.y0 = Vector{{solution.state[0], -restitution * solution.state[1]}};
    flight *= restitution;
    expected += flight;
  }
}

/// Times where the pendulum from rest at angle φ₀ hangs down: (2n + 1) K(sin ½φ₀), K the complete elliptic
/// integral.
void check_pendulum(const StepControl& control, const std::string& name, double tolerance) {
  const double amplitude = 2.0, quarter = std::comp_ellint_1(std::sin(0.5 * amplitude));
  const Ivp ivp = problem(Pendulum{}, Vector{{amplitude, 0.0}}, 10.5 * quarter);
  const std::vector<Event> events =
      events_of(ivp, control, name, {component(0, 0.0)}, {.time_tolerance = 1e-13});
  ASSERT_EQ(events.size(), 5u) << name;
  for (std::size_t n = 0; n < events.size(); ++n) {
    const double exact = (2.0 * static_cast<double>(n) + 1.0) * quarter;
    EXPECT_NEAR(events[n].time, exact, tolerance) << name << " crossing " << n;
    // On its lowest point |φ̇| = 2 sin ½φ₀.
    EXPECT_NEAR(std::abs(events[n].state[1]), 2.0 * std::sin(0.5 * amplitude), tolerance) << name;
  }
}

TEST(EventLocator, FindsThePassagesOfAPendulumByEllipticIntegrals) {
  check_pendulum(AdaptiveStep{1e-11, 1e-13}, "dormand_prince_54", 1e-9);
  // Polynomials through side steps and side steps: as good as the steps, however long these are.
  check_pendulum(AdaptiveStep{1e-12, 1e-13}, "cash_karp_54", 2e-10);
  check_pendulum(AdaptiveStep{1e-11, 1e-13}, "verner_87", 1e-9);
  check_pendulum(FixedStep{.step = 1e-3}, "rk4", 1e-11);
  check_pendulum(FixedStep{.step = 1e-3}, "dormand_prince_54", 1e-12);
}

TEST(EventLocator, IsAsAccurateAsTheDenseOutputNotAsAStraightLine) {
  // y = cos t with h = 0.1 falls through 0.3 at arccos 0.3, between 1.2 and 1.3.
  const double exact = std::acos(0.3);
  const Ivp ivp = problem(Circle{}, Vector{{1.0, 0.0}}, 2.0);
  const std::vector<Event> events = events_of(ivp, FixedStep{.step = 0.1}, "rk4", {component(0, 0.3)});
  ASSERT_EQ(events.size(), 1u);
  const double ya = std::cos(1.2), yb = std::cos(1.3);
  const double straight = 1.2 + 0.1 * (ya - 0.3) / (ya - yb);
  EXPECT_GT(std::abs(straight - exact), 1e-4);
  EXPECT_LT(std::abs(events[0].time - exact), 1e-6);
}

TEST(EventLocator, KeepsTheTimeToleranceAndNeedsFewEvaluations) {
  const Ivp ivp = problem(Circle{}, Vector{{1.0, 0.0}}, 2.0);
  for (const double tolerance : {1e-3, 1e-6, 1e-9, 1e-12}) {
    int evaluations = 0;
    const double root = 0.7123456789012345;
    // Flat on one side and steep on the other: regula falsi would creep.
    const EventFunction bent{"bent", [&](double t, ConstVectorRef) {
                               ++evaluations;
                               return std::expm1(20.0 * (t - root));
                             }};
    const std::vector<Event> events =
        events_of(ivp, FixedStep{.step = 2.0}, "rk4", {bent}, {.time_tolerance = tolerance});
    ASSERT_EQ(events.size(), 1u);
    EXPECT_GE(events[0].time, root);
    EXPECT_LE(events[0].time, root + tolerance);
    EXPECT_LE(evaluations, 2 + 2 + static_cast<int>(std::ceil(std::log2(2.0 / tolerance)))) << tolerance;
  }
  int evaluations = 0;
  const EventFunction smooth{"smooth", [&](double, ConstVectorRef y) {
                               ++evaluations;
                               return y[0] - 0.3;
                             }};
  events_of(ivp, FixedStep{.step = 1.0}, "dormand_prince_54", {smooth}, {.time_tolerance = 1e-12});
  EXPECT_LE(evaluations, 3 + 11) << "bisection takes 40";
}

TEST(EventLocator, EndsAtNeighbouringDoublesWhereTheToleranceIsBelowThem) {
  const Ivp ivp = problem(Circle{}, Vector{{1.0, 0.0}}, 8.0);
  const std::vector<Event> events =
      events_of(ivp, FixedStep{.step = 4.0}, "rk4", {at_time(5.1)}, {.time_tolerance = 1e-300});
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].time, 5.1);
}

TEST(EventLocator, RespectsDirections) {
  const Ivp ivp = problem(Circle{}, Vector{{1.0, 0.0}}, 12.0);
  for (const StepControl& control :
       {StepControl(FixedStep{.step = 0.01}), StepControl(AdaptiveStep{1e-10, 1e-12})}) {
    const std::vector<Event> events =
        events_of(ivp, control, "dormand_prince_54",
                  {component(0, 0.0, EventDirection::rising), component(0, 0.0, EventDirection::falling),
                   component(0, 0.0)});
    std::vector<double> rising, falling, both;
    for (const Event& event : events) {
      (event.function == 0 ? rising : event.function == 1 ? falling : both).push_back(event.time);
    }
    ASSERT_EQ(rising.size(), 2u);
    ASSERT_EQ(falling.size(), 2u);
    ASSERT_EQ(both.size(), 4u);
    EXPECT_NEAR(falling[0], 0.5 * pi, 1e-8);
    EXPECT_NEAR(rising[0], 1.5 * pi, 1e-8);
    EXPECT_NEAR(falling[1], 2.5 * pi, 1e-8);
    EXPECT_NEAR(rising[1], 3.5 * pi, 1e-8);
    EXPECT_EQ(both[3], rising[1]);
  }
}

TEST(EventLocator, ReportsSeveralEventsOfOneStepInTheOrderOfTime) {
  const Ivp ivp = problem(Circle{}, Vector{{1.0, 0.0}}, 1.0);
  const std::vector<Event> events = events_of(ivp, FixedStep{.step = 1.0}, "rk4",
                                              {at_time(0.75), at_time(0.25), at_time(0.5), at_time(0.25)});
  ASSERT_EQ(events.size(), 4u);
  const std::vector<std::size_t> order = {events[0].function, events[1].function, events[2].function,
                                          events[3].function};
  EXPECT_EQ(order, (std::vector<std::size_t>{1, 3, 2, 0}));
}

TEST(EventLocator, StopsAtTheFirstTerminalEventAndForgetsLaterOnesOfTheStep) {
  const Ivp ivp = problem(Circle{}, Vector{{1.0, 0.0}}, 3.0);
  TrajectoryRecorder inner;
  EventLocator locator({at_time(1.875), at_time(1.625, true), at_time(1.25), at_time(1.75, true)}, inner);
  const Solution solution = solve_with_events(*method("rk4"), ivp, FixedStep{.step = 1.0}, locator);
  ASSERT_EQ(locator.events().size(), 2u);
  EXPECT_EQ(locator.events()[0].function, 2u);
  ASSERT_NE(locator.terminal_event(), nullptr);
  EXPECT_EQ(locator.terminal_event()->function, 1u);
  EXPECT_NEAR(solution.time, 1.625, 1e-10);
  EXPECT_EQ(solution.status.code, StatusCode::stopped_by_observer);
  EXPECT_NE(solution.status.message.find("clock"), std::string::npos) << solution.status.message;
  // The inner observer: 0, 1, and the event in place of 2.
  ASSERT_EQ(inner.times().size(), 3u);
  EXPECT_EQ(inner.times()[1], 1.0);
  EXPECT_EQ(inner.times()[2], solution.time);
  EXPECT_EQ(inner.states()[2], solution.state);
  EXPECT_NEAR(solution.state[0], std::cos(1.625), 2e-2);
}

TEST(EventLocator, StopsAtATerminalEventInTheLastStep) {
  const Ivp ivp = problem(Circle{}, Vector{{1.0, 0.0}}, 2.0);
  NullObserver nobody;
  for (const StepControl& control :
       {StepControl(FixedStep{.step = 0.3}), StepControl(AdaptiveStep{1e-8, 1e-10})}) {
    EventLocator locator({at_time(1.99999, true)}, nobody);
    const Solution solution = solve_with_events(*method("dormand_prince_54"), ivp, control, locator);
    EXPECT_EQ(solution.status.code, StatusCode::stopped_by_observer);
    EXPECT_NEAR(solution.time, 1.99999, 1e-10);
    EXPECT_NEAR(solution.state[0], std::cos(1.99999), 1e-5);
  }
}

TEST(EventLocator, DoesNotReportAZeroAtTheStartButTheReturnToIt) {
  // sin t: zero at the start, then at π and 2π.
  const Ivp ivp = problem(Circle{}, Vector{{1.0, 0.0}}, 7.0);
  const std::vector<Event> events =
      events_of(ivp, AdaptiveStep{1e-11, 1e-13}, "dormand_prince_54", {component(1, 0.0)});
  ASSERT_EQ(events.size(), 2u);
  EXPECT_NEAR(events[0].time, pi, 1e-9);
  EXPECT_NEAR(events[1].time, 2.0 * pi, 1e-9);
}

TEST(EventLocator, ReportsAZeroExactlyAtAStepOnceWhenItIsReached) {
  const Ivp ivp = problem(Circle{}, Vector{{1.0, 0.0}}, 2.0);
  // Steps of 1/4 are exact, so is g at t = 1; the crossing, the touch and the end of the interval.
  const EventFunction touch{"touch", [](double t, ConstVectorRef) { return (t - 1.0) * (t - 1.0); }};
  const std::vector<Event> events =
      events_of(ivp, FixedStep{.step = 0.25}, "rk4", {at_time(1.0), touch, at_time(2.0)});
  ASSERT_EQ(events.size(), 3u);
  EXPECT_EQ(events[0].time, 1.0);
  EXPECT_EQ(events[0].function, 0u);
  EXPECT_EQ(events[1].time, 1.0);
  EXPECT_EQ(events[1].function, 1u);
  EXPECT_EQ(events[2].time, 2.0);
  EXPECT_EQ(events[2].function, 2u);
}

TEST(EventLocator, MissesPairsOfZerosBetweenSamplesAndFindsThemWithMore) {
  const Ivp ivp = problem(Circle{}, Vector{{1.0, 0.0}}, 1.0);
  const EventFunction grazing{"grazing", [](double t, ConstVectorRef) { return (t - 0.3) * (t - 0.3); }};
  const EventFunction pair{"pair", [](double t, ConstVectorRef) { return (t - 0.3) * (t - 0.6); }};
  const FixedStep one_step{.step = 1.0};
  EXPECT_TRUE(events_of(ivp, one_step, "rk4", {grazing}, {.samples_per_step = 7}).empty());
  EXPECT_TRUE(events_of(ivp, one_step, "rk4", {pair}).empty());
  const std::vector<Event> events = events_of(ivp, one_step, "rk4", {pair}, {.samples_per_step = 4});
  ASSERT_EQ(events.size(), 2u);
  EXPECT_NEAR(events[0].time, 0.3, 1e-10);
  EXPECT_NEAR(events[1].time, 0.6, 1e-10);
}

TEST(EventLocator, LeavesTheRunAsItIs) {
  const Ivp ivp = problem(Pendulum{}, Vector{{2.0, 0.0}}, 8.0);
  const AdaptiveStep control{1e-8, 1e-10};
  TrajectoryRecorder plain, watched;
  EventLocator locator({component(0, 0.0)}, watched);
  const Solution alone = method("dormand_prince_54")->solve(ivp, control, plain);
  const Solution together = solve_with_events(*method("dormand_prince_54"), ivp, control, locator);
  EXPECT_EQ(alone.state, together.state);
  EXPECT_EQ(plain.times(), watched.times());
  EXPECT_EQ(plain.states(), watched.states());
  EXPECT_EQ(together.status.code, StatusCode::success);
}

TEST(EventLocator, PassesTheStopOfTheInnerObserverOn) {
  struct Impatient final : Observer {
    bool observe(const StepView& view) override { return view.index < 3; }
  } inner;
  const Ivp ivp = problem(Circle{}, Vector{{1.0, 0.0}}, 1.0);
  EventLocator locator({at_time(0.9)}, inner);
  const Solution solution = solve_with_events(*method("rk4"), ivp, FixedStep{.step = 0.125}, locator);
  EXPECT_EQ(solution.status.code, StatusCode::stopped_by_observer);
  EXPECT_EQ(solution.time, 0.375);
  EXPECT_TRUE(locator.events().empty());
}

TEST(EventLocator, RefusesAMethodWithoutInterpolation) {
  NullObserver nobody;
  EventLocator locator({at_time(0.5)}, nobody);
  const Vector state = Vector::Zero(1);
  const std::function<void(double, VectorRef)> none;
  EXPECT_TRUE(locator.observe({0, 0.0, state, false, none}));
  // Even where no event lies in the step: what a run can do must not depend on its course.
  EXPECT_THROW(locator.observe({1, 0.25, state, false, none}), InputError);
}

TEST(EventLocator, RefusesBadOptionsAndValuesThatAreNotFinite) {
  NullObserver nobody;
  EXPECT_THROW(EventLocator({at_time(1.0)}, nobody, {.time_tolerance = 0.0}), InputError);
  EXPECT_THROW(EventLocator({at_time(1.0)}, nobody, {.time_tolerance = std::nan("")}), InputError);
  EXPECT_THROW(EventLocator({at_time(1.0)}, nobody, {.samples_per_step = 0}), InputError);
  EXPECT_THROW(EventLocator({EventFunction{"hollow"}}, nobody), InputError);
  const Ivp ivp = problem(Circle{}, Vector{{1.0, 0.0}}, 2.0);
  EventLocator locator({{"root", [](double t, ConstVectorRef) { return std::sqrt(1.0 - t); }}}, nobody);
  try {
    solve_with_events(*method("rk4"), ivp, FixedStep{.step = 0.25}, locator);
    FAIL() << "a NaN went through";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("root"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace fw
