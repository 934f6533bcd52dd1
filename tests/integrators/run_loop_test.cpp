#include "integrators/loop/run_loop.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>

#include "integrators/network.hpp"
#include "integrators/saved_run.hpp"
#include "integrators/special/verlet.hpp"
#include "ode/functor_system.hpp"

namespace fw::integrators {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Calls a function at every accepted step.
class Hook final : public StepHook {
 public:
  using Function = std::function<Change(double t, VectorRef y)>;
  explicit Hook(Function function) : function_(std::move(function)) {}
  Change on_accepted(double t, VectorRef y) override { return function_(t, y); }

 private:
  Function function_;
};

/// ẏ = 1.
struct Clock {
  template <class S>
  void operator()(const S&, std::span<const S>, std::span<S> dydt) const {
    dydt[0] = S(1);
  }
};

Ivp clock(double end) {
  return {std::make_shared<FunctorSystem<Clock>>(1, Clock{}), 0.0, end, Vector{{0.0}}, {}};
}

TEST(RunLoop, ShowsTheChangedStateAndGoesOnFromIt) {
  Hook doubled([](double, VectorRef y) {
    y *= 2.0;
    return Change::state;
  });
  for (const char* name : {"rk4", "dormand_prince_54"}) {
    StepRecord record;
    const Solution solution =
        explicit_runge_kutta(name)->solve(clock(1.0), FixedStep{.step = 0.25}, record, {.hook = &doubled});
    ASSERT_TRUE(solution.status.ok());
    // y ← 2(y + h), the last time too.
    std::vector<double> values, inside;
    for (const Vector& y : record.states) values.push_back(y[0]);
    for (const Vector& y : record.insides) inside.push_back(y[0]);
    const auto near = [](double value) { return testing::DoubleNear(value, 4e-15); };  // weights are rounded
    EXPECT_THAT(values, ElementsAre(0.0, near(0.5), near(1.5), near(3.5), near(7.5))) << name;
    EXPECT_EQ(solution.state[0], values.back());
    // Inside a step the solution is that of the method.
    const double two_thirds = 0.25 * 2.0 / 3.0;
    ASSERT_EQ(inside.size(), 4u);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(inside[k], values[k] + two_thirds, 1e-15) << name;
  }
}

TEST(RunLoop, KeepsWhatAMethodKnowsWhereAHookChangesNothing) {
  const Ivp ivp = random_network(3, {}, 0.5);
  int calls = 0;
  Hook idle([&](double, VectorRef) {
    ++calls;
    return Change::none;
  });
  for (const auto& integrator :
       {make_verlet(VerletVelocity::central), explicit_runge_kutta("dormand_prince_54")}) {
    StepRecord with, without;
    const FixedStep control{.step = 1.0 / 64.0};
    const Solution watched = integrator->solve(ivp, control, with, {.hook = &idle});
    const Solution plain = integrator->solve(ivp, control, without);
    EXPECT_EQ(difference_from_end(without, with), "");
    EXPECT_EQ(difference(watched.work, plain.work), "");
  }
  EXPECT_EQ(calls, 64);
}

TEST(RunLoop, RefusesAStateThatAHookHasSpoiled) {
  Hook spoils([](double t, VectorRef y) {
    if (t > 0.4) y[0] = std::numeric_limits<double>::quiet_NaN();
    return Change::state;
  });
  NullObserver observer;
  const Solution solution =
      explicit_runge_kutta("rk4")->solve(clock(1.0), FixedStep{.step = 0.25}, observer, {.hook = &spoils});
  EXPECT_EQ(solution.status.code, StatusCode::non_finite);
  EXPECT_EQ(solution.time, 0.25);
}

TEST(RunLoop, StopsWhenAskedAndSaysWhere) {
  std::atomic<bool> asked{false};
  Hook asks([&](double t, VectorRef) {
    asked = t >= 0.5;
    return Change::none;
  });
  for (const StepControl& control :
       {StepControl(FixedStep{.step = 0.25}), StepControl(AdaptiveStep{.maximum_step = 0.25})}) {
    StepRecord record;
    asked = false;
    const Solution solution =
        explicit_runge_kutta("dormand_prince_54")
            ->solve(clock(2.0), control, record, {.stop = StopToken(asked), .hook = &asks});
    EXPECT_EQ(solution.status.code, StatusCode::interrupted);
    EXPECT_THAT(solution.status.message, HasSubstr("interrupted by the user at t = "));
    EXPECT_EQ(solution.time, record.times.back());
    EXPECT_GE(solution.time, 0.5);
    EXPECT_LT(solution.time, 0.8);
  }
}

TEST(RunLoop, FinishesTheStepThatReachesTheEndThoughItIsAsked) {
  std::atomic<bool> asked{false};
  Hook asks([&](double t, VectorRef) {
    asked = t >= 1.0;
    return Change::none;
  });
  NullObserver observer;
  const Solution solution = explicit_runge_kutta("rk4")->solve(clock(1.0), FixedStep{.step = 0.25}, observer,
                                                               {.stop = StopToken(asked), .hook = &asks});
  EXPECT_TRUE(solution.status.ok());
}

/// A point on the circle |q| = 1 without its constraint: only the force of the rod holds it there.
struct Pendulum {
  template <class S>
  void operator()(const S&, std::span<const S> q, std::span<const S> v, std::span<S> f) const {
    // The force of the rod, −(|v|² + g·q) q/|q|², and gravity.
    const S square = q[0] * q[0] + q[1] * q[1];
    const S tension = (v[0] * v[0] + v[1] * v[1] - S(9.81) * q[1]) / square;
    f[0] = -tension * q[0];
    f[1] = -tension * q[1] - S(9.81);
  }
};

/// What constraints will do at every step.
TEST(RunLoop, KeepsAProjectedPendulumOnItsCircleWithTheOrderOfTheMethod) {
  const Ivp ivp{std::make_shared<FunctorSecondOrderSystem<Pendulum>>(Vector{{1.0, 1.0}}, ForceClass::velocity,
                                                                     Pendulum{}),
                0.0,
                1.0,
                Vector{{1.0, 0.0, 0.0, 0.0}},
                {}};
  Hook project([](double, VectorRef y) {
    y.head(2) /= y.head(2).norm();
    y.tail(2) -= y.head(2).dot(y.tail(2)) * y.head(2);
    return Change::state;
  });
  const auto end = [&](double step) {
    NullObserver observer;
    return explicit_runge_kutta("rk4")
        ->solve(ivp, FixedStep{.step = step}, observer, {.hook = &project})
        .state;
  };
  const Vector exact = end(1.0 / 2048.0), coarse = end(1.0 / 64.0), fine = end(1.0 / 128.0);
  EXPECT_NEAR(fine.head(2).norm(), 1.0, 4e-16);
  EXPECT_NEAR(std::log2((coarse - exact).norm() / (fine - exact).norm()), 4.0, 0.4);
}

}  // namespace
}  // namespace fw::integrators
