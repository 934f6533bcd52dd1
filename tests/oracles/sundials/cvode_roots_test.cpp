#include "oracles/sundials/cvode_roots.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"
#include "integrators/network.hpp"
#include "ode/functor_system.hpp"

namespace fw::oracles {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double gravity = 9.81;
constexpr AdaptiveStep tight{.relative_tolerance = 1e-10, .absolute_tolerance = 1e-12};

struct FreeFall {
  template <class S>
  void operator()(const S&, std::span<const S> y, std::span<S> dydt) const {
    dydt[0] = y[1];
    dydt[1] = S(-gravity);
  }
};

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

template <class Functor>
Ivp problem(const Functor& functor, Vector y0, double t1) {
  Ivp ivp;
  ivp.system = std::make_shared<FunctorSystem<Functor>>(y0.size(), functor);
  ivp.y0 = std::move(y0);
  ivp.t1 = t1;
  return ivp;
}

EventFunction component(Index i, double level, EventDirection direction = EventDirection::both,
                        bool terminal = false) {
  return {"component", [=](double, ConstVectorRef y) { return y[i] - level; }, direction, terminal};
}

EventFunction at_time(double time, bool terminal = false) {
  return {"clock", [=](double t, ConstVectorRef) { return t - time; }, EventDirection::both, terminal};
}

SolutionWithEvents run(const Ivp& ivp, const std::vector<EventFunction>& functions,
                       CvodeFormula formula = CvodeFormula::adams, const CvodeOptions& options = {}) {
  NullObserver nobody;
  return solve_with_cvode_roots(formula, options, ivp, tight, functions, nobody);
}

TEST(CvodeRoots, FindsThePassagesOfAPendulumByEllipticIntegrals) {
  const double amplitude = 2.0, quarter = std::comp_ellint_1(std::sin(0.5 * amplitude));
  const Ivp ivp = problem(Pendulum{}, Vector{{amplitude, 0.0}}, 10.5 * quarter);
  for (const auto formula : {CvodeFormula::bdf, CvodeFormula::adams}) {
    for (const auto vector : {VectorOperations::eigen, VectorOperations::serial}) {
      const auto [solution, events] = run(ivp, {component(0, 0.0)}, formula, {.vector = vector});
      ASSERT_TRUE(solution.status.ok()) << solution.status.describe();
      EXPECT_EQ(solution.time, ivp.t1);
      ASSERT_EQ(events.size(), 5u);
      for (std::size_t n = 0; n < events.size(); ++n) {
        EXPECT_NEAR(events[n].time, (2.0 * static_cast<double>(n) + 1.0) * quarter, 2e-9);
        EXPECT_NEAR(std::abs(events[n].state[1]), 2.0 * std::sin(0.5 * amplitude), 2e-9);
      }
    }
  }
}

TEST(CvodeRoots, FollowsABouncingBallOverTenImpacts) {
  const double height = 0.8, restitution = 0.7, first = std::sqrt(2.0 * height / gravity);
  Ivp ivp = problem(FreeFall{}, Vector{{height, 0.0}}, 100.0);
  double expected = first, flight = 2.0 * first;
  for (int impact = 0; impact < 10; ++impact) {
    const auto [solution, events] = run(ivp, {component(0, 0.0, EventDirection::falling, true)});
    ASSERT_EQ(solution.status.code, StatusCode::stopped_by_observer) << solution.status.describe();
    ASSERT_EQ(events.size(), 1u);
    EXPECT_NEAR(solution.time, expected, 1e-10) << "impact " << impact;
    EXPECT_EQ(solution.time, events[0].time);
    EXPECT_EQ(solution.state, events[0].state);
    ivp.t0 = solution.time;
    ivp.y0 = Vector{{0.0, -restitution * solution.state[1]}};
    flight *= restitution;
    expected += flight;
  }
}

TEST(CvodeRoots, AgreesWithOurEventLocatorOnASpringNetwork) {
  const Ivp ivp = integrators::random_network(41, {}, 2.0);
  std::vector<EventFunction> functions;
  for (Index i = 0; i < 6; ++i) functions.push_back(component(i, ivp.y0[i] + 0.01));
  functions.push_back(component(2, ivp.y0[2], EventDirection::rising));
  functions.push_back(component(2, ivp.y0[2], EventDirection::falling));
  const auto [solution, events] = run(ivp, functions);
  ASSERT_TRUE(solution.status.ok());
  NullObserver nobody;
  EventLocator locator(functions, nobody, {.time_tolerance = 1e-12});
  const Solution ours = solve_with_events(*make_cvode_adams(), ivp, tight, locator);
  EXPECT_EQ(ours.state, solution.state) << "root finding must not change the run";
  ASSERT_GE(events.size(), 5u);
  ASSERT_EQ(events.size(), locator.events().size());
  for (std::size_t k = 0; k < events.size(); ++k) {
    EXPECT_EQ(events[k].function, locator.events()[k].function) << k;
    EXPECT_NEAR(events[k].time, locator.events()[k].time, 2e-12) << k;
    EXPECT_LT((events[k].state - locator.events()[k].state).lpNorm<Eigen::Infinity>(), 1e-10) << k;
  }
}

TEST(CvodeRoots, RespectsDirections) {
  const Ivp ivp = problem(Circle{}, Vector{{1.0, 0.0}}, 12.0);
  const auto events = run(ivp, {component(0, 0.0, EventDirection::rising),
                                component(0, 0.0, EventDirection::falling), component(0, 0.0)})
                          .events;
  std::vector<double> rising, falling, both;
  for (const Event& event : events) {
    (event.function == 0 ? rising : event.function == 1 ? falling : both).push_back(event.time);
  }
  ASSERT_EQ(rising.size(), 2u);
  ASSERT_EQ(falling.size(), 2u);
  ASSERT_EQ(both.size(), 4u);
  EXPECT_NEAR(falling[0], 0.5 * pi, 1e-8);
  EXPECT_NEAR(rising[0], 1.5 * pi, 1e-8);
  EXPECT_EQ(both[3], rising[1]);
}

TEST(CvodeRoots, ReportsSeveralEventsOfOneStepInOrderAndStopsAtTheFirstTerminalOne) {
  const Ivp ivp = problem(Circle{}, Vector{{1.0, 0.0}}, 3.0);
  const auto [solution, events] = run(ivp, {at_time(1.625 + 1e-9), at_time(1.625, true), at_time(1.25),
                                            at_time(1.625), at_time(1.625 - 1e-9)});
  ASSERT_EQ(events.size(), 3u);
  EXPECT_EQ(events[0].function, 2u);
  EXPECT_EQ(events[1].function, 4u);
  EXPECT_EQ(events[2].function, 1u) << "function 3 has the same time but comes after the end";
  EXPECT_NEAR(solution.time, 1.625, 1e-12);
  EXPECT_NEAR(solution.state[0], std::cos(1.625), 1e-8);
  EXPECT_NE(solution.status.message.find("clock"), std::string::npos);
}

TEST(CvodeRoots, DoesNotReportAZeroAtTheStartButTheReturnToIt) {
  const Ivp ivp = problem(Circle{}, Vector{{1.0, 0.0}}, 7.0);
  const auto events = run(ivp, {component(1, 0.0)}).events;
  ASSERT_EQ(events.size(), 2u);
  EXPECT_NEAR(events[0].time, pi, 1e-8);
  EXPECT_NEAR(events[1].time, 2.0 * pi, 1e-8);
}

TEST(CvodeRoots, ShowsTheObserverTheRunAsItIsAndTheTerminalEventAtLast) {
  const Ivp ivp = problem(Pendulum{}, Vector{{2.0, 0.0}}, 8.0);
  TrajectoryRecorder plain, watched, ended;
  make_cvode_adams()->solve(ivp, tight, plain);
  solve_with_cvode_roots(CvodeFormula::adams, {}, ivp, tight, {component(0, 0.0), at_time(5.0)}, watched);
  EXPECT_EQ(plain.times(), watched.times());
  EXPECT_EQ(plain.states(), watched.states());
  const auto result =
      solve_with_cvode_roots(CvodeFormula::adams, {}, ivp, tight, {at_time(5.0, true)}, ended);
  EXPECT_EQ(ended.times().back(), result.solution.time);
  EXPECT_EQ(ended.states().back(), result.solution.state);
  EXPECT_EQ(ended.times().size(), result.solution.work.accepted_steps + 2);
  for (std::size_t k = 0; k + 1 < ended.times().size(); ++k) EXPECT_EQ(ended.times()[k], plain.times()[k]);
}

TEST(CvodeRoots, RefusesFunctionsThatAreEmptyNotFiniteOrThrow) {
  const Ivp ivp = problem(Circle{}, Vector{{1.0, 0.0}}, 2.0);
  EXPECT_THROW(run(ivp, {EventFunction{"hollow"}}), InputError);
  try {
    run(ivp, {{"root", [](double t, ConstVectorRef) { return std::sqrt(1.0 - t); }}});
    FAIL() << "a NaN went through";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("root"), std::string::npos) << error.what();
  }
  const EventFunction throws{"throws", [](double t, ConstVectorRef) {
                               if (t > 0.5) throw std::domain_error("beyond");
                               return 1.0;
                             }};
  EXPECT_THROW(run(ivp, {throws}), std::domain_error);
}

TEST(CvodeRoots, WorksWithoutEventFunctions) {
  const Ivp ivp = problem(Circle{}, Vector{{1.0, 0.0}}, 1.0);
  const auto [solution, events] = run(ivp, {});
  EXPECT_TRUE(solution.status.ok());
  EXPECT_TRUE(events.empty());
}

}  // namespace
}  // namespace fw::oracles
