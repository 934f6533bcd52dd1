#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "integrators/tableau/explicit_runge_kutta.hpp"
#include "ode/functor_system.hpp"
#include "schemes/explicit_tableaus.hpp"

namespace fw::integrators {
namespace {

std::unique_ptr<Integrator> method(const std::string& name, const ControllerOptions& controller = {}) {
  const auto& tableaus = schemes::explicit_tableaus();
  const auto found = std::ranges::find(tableaus, name, &schemes::ButcherTableau::name);
  EXPECT_NE(found, tableaus.end()) << name;
  return make_explicit_runge_kutta(*found, controller);
}

template <class Functor>
Ivp problem(Functor functor, Vector y0, double t1) {
  Ivp ivp;
  ivp.system = std::make_shared<FunctorSystem<Functor>>(y0.size(), std::move(functor));
  ivp.y0 = std::move(y0);
  ivp.t1 = t1;
  return ivp;
}

struct Circle {
  template <class S>
  void operator()(const S&, std::span<const S> y, std::span<S> dydt) const {
    dydt[0] = y[1];
    dydt[1] = -y[0];
  }
};

/// ẏ = y cos t, y = e^{sin t}.
struct PeriodicGrowth {
  template <class S>
  void operator()(const S& t, std::span<const S> y, std::span<S> dydt) const {
    using std::cos;
    dydt[0] = y[0] * cos(t);
  }
};

/// ẏ = y², infinite at t = 1 from y(0) = 1.
struct FiniteTimeBlowUp {
  template <class S>
  void operator()(const S&, std::span<const S> y, std::span<S> dydt) const {
    dydt[0] = y[0] * y[0];
  }
};

/// ẏ = −√y, y = (1 − t/2)²; a stage that overshoots below zero is NaN.
struct Draining {
  template <class S>
  void operator()(const S&, std::span<const S> y, std::span<S> dydt) const {
    using std::sqrt;
    dydt[0] = -sqrt(y[0]);
  }
};

/// ẏ = 1 up to t = ½, not defined later.
struct UndefinedLater {
  template <class S>
  void operator()(const S& t, std::span<const S>, std::span<S> dydt) const {
    dydt[0] = real_part(t) > 0.5 ? S(std::numeric_limits<double>::quiet_NaN()) : S(1);
  }
};

/// A narrow force pulse that no step chosen before can know of.
struct Pulse {
  template <class S>
  void operator()(const S& t, std::span<const S>, std::span<S> dydt) const {
    using std::exp;
    dydt[0] = exp(-S(1e4) * (t - S(1)) * (t - S(1)));
  }
};

Ivp circle(double t1) {
  return problem(Circle{}, Vector{{1.0, 0.0}}, t1);
}

double circle_error(ConstVectorRef y, double t) {
  return std::hypot(y[0] - std::cos(t), y[1] + std::sin(t));
}

struct WatchedRun {
  Solution solution;
  TrajectoryRecorder trajectory;
  std::vector<double> steps() const {
    std::vector<double> result;
    const std::vector<double>& times = trajectory.times();
    for (std::size_t i = 1; i < times.size(); ++i) result.push_back(times[i] - times[i - 1]);
    return result;
  }
};

WatchedRun solve(const std::string& name, const Ivp& ivp, const AdaptiveStep& control,
                 const ControllerOptions& controller = {}) {
  WatchedRun run;
  run.solution = method(name, controller)->solve(ivp, control, run.trajectory);
  return run;
}

TEST(AdaptiveLoop, HitsTheEndTimeExactly) {
  for (const double t1 : {0.1 + 0.2, 1.0 / 3.0, 7.7, 1e-9, 1234.5678}) {
    for (const char* name : {"dormand_prince_54", "bogacki_shampine_32", "cash_karp_54"}) {
      const WatchedRun run =
          solve(name, circle(t1), {.relative_tolerance = 1e-3, .absolute_tolerance = 1e-6});
      ASSERT_TRUE(run.solution.status.ok()) << run.solution.status.describe();
      EXPECT_EQ(run.solution.time, t1) << name;
      EXPECT_EQ(run.trajectory.times().back(), t1) << name;
      EXPECT_EQ(run.trajectory.states().back(), run.solution.state) << name;
      EXPECT_EQ(run.solution.work.accepted_steps + 1, run.trajectory.times().size()) << name;
      EXPECT_TRUE(std::ranges::is_sorted(run.trajectory.times(), std::less_equal<>{}));
    }
  }
}

TEST(AdaptiveLoop, EndsWithoutASliver) {
  // The last step is not much shorter than those before it, whatever the end time.
  for (double t1 = 10.0; t1 < 11.0; t1 += 0.0371) {
    const std::vector<double> steps = solve("dormand_prince_54", circle(t1), {1e-6, 1e-9}).steps();
    ASSERT_GT(steps.size(), 5u);
    EXPECT_GT(steps.back(), 0.4 * steps[steps.size() - 3]) << t1;
  }
}

TEST(AdaptiveLoop, EveryControllerAndNormReachesTheTolerance) {
  for (const char* name : {"dormand_prince_54", "bogacki_shampine_32", "cash_karp_54", "tsitouras_54"}) {
    for (const auto kind : {ControllerKind::integral, ControllerKind::proportional_integral,
                            ControllerKind::proportional_integral_derivative}) {
      for (const auto norm : {ErrorNorm::root_mean_square, ErrorNorm::maximum}) {
        double previous = 1.0;
        for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
          const WatchedRun run =
              solve(name, circle(10.0), {.relative_tolerance = tolerance, .absolute_tolerance = tolerance},
                    {.kind = kind, .norm = norm});
          ASSERT_TRUE(run.solution.status.ok()) << name << ": " << run.solution.status.describe();
          const double error = circle_error(run.solution.state, 10.0);
          // Local errors of one tolerance per step add up over ten radians; far below it, work would be
          // wasted.
          EXPECT_LT(error, 30.0 * tolerance) << name;
          EXPECT_GT(error, tolerance / 100.0) << name;
          EXPECT_LT(error, 0.1 * previous) << name << ": the error follows the tolerance";
          previous = error;
        }
      }
    }
  }
}

TEST(AdaptiveLoop, NormsAndControllersDiffer) {
  // A scheme that ignored its options would pass the test above.
  const AdaptiveStep control{1e-6, 1e-6};
  const Ivp ivp = problem(PeriodicGrowth{}, Vector{{1.0}}, 20.0);
  std::vector<std::vector<double>> times;
  for (const auto kind : {ControllerKind::integral, ControllerKind::proportional_integral,
                          ControllerKind::proportional_integral_derivative}) {
    times.push_back(solve("dormand_prince_54", ivp, control, {.kind = kind}).trajectory.times());
  }
  EXPECT_NE(times[0], times[1]);
  EXPECT_NE(times[1], times[2]);
  EXPECT_NE(times[0], times[2]);
  const auto steps = [&](ErrorNorm norm) {
    return solve("dormand_prince_54", circle(20.0), control, {.norm = norm}).solution.work.accepted_steps;
  };
  EXPECT_GT(steps(ErrorNorm::maximum), steps(ErrorNorm::root_mean_square));
}

TEST(AdaptiveLoop, StopsAtTheStepLimitWithTheLastGoodState) {
  const WatchedRun run = solve("dormand_prince_54", circle(1000.0),
                               {.relative_tolerance = 1e-8, .absolute_tolerance = 1e-8, .maximum_steps = 50});
  EXPECT_EQ(run.solution.status.code, StatusCode::step_limit);
  EXPECT_NE(run.solution.status.message.find("50"), std::string::npos) << run.solution.status.message;
  EXPECT_EQ(run.solution.work.accepted_steps + run.solution.work.rejected_steps, 50u);
  EXPECT_GT(run.solution.time, 0.0);
  EXPECT_EQ(run.solution.time, run.trajectory.times().back());
  EXPECT_LT(circle_error(run.solution.state, run.solution.time), 1e-6);
}

TEST(AdaptiveLoop, ReportsStepsThatShrinkToNothingBeforeASingularity) {
  for (const char* name : {"dormand_prince_54", "bogacki_shampine_32"}) {
    const WatchedRun run = solve(name, problem(FiniteTimeBlowUp{}, Vector{{1.0}}, 2.0), {1e-6, 1e-9});
    EXPECT_EQ(run.solution.status.code, StatusCode::step_too_small) << run.solution.status.describe();
    EXPECT_NEAR(run.solution.time, 1.0, 1e-4) << name;
    EXPECT_TRUE(run.solution.state.allFinite()) << name;
    EXPECT_GT(run.solution.state[0], 1e3) << name;
  }
}

TEST(AdaptiveLoop, RefusesToGoBelowTheMinimumStep) {
  AdaptiveStep control{1e-10, 1e-12};
  const double smallest = std::ranges::min(solve("dormand_prince_54", circle(10.0), control).steps());
  control.minimum_step = 0.2;
  const WatchedRun run = solve("dormand_prince_54", circle(10.0), control);
  ASSERT_LT(smallest, 0.2);
  EXPECT_EQ(run.solution.status.code, StatusCode::step_too_small);
  EXPECT_NE(run.solution.status.message.find("0.2"), std::string::npos) << run.solution.status.message;
}

TEST(AdaptiveLoop, DoesNotMistakeTheEndForAStepBelowTheMinimum) {
  // The error test would allow 0.3: a minimum of 0.25 is no obstacle for any end time, nor for the chosen
  // first step.
  for (double t1 = 1.0; t1 < 3.0; t1 += 0.0437) {
    const WatchedRun run = solve(
        "dormand_prince_54", circle(t1),
        {.relative_tolerance = 1e-3, .absolute_tolerance = 1e-3, .minimum_step = 0.25, .maximum_step = 0.4});
    ASSERT_TRUE(run.solution.status.ok()) << t1 << ": " << run.solution.status.describe();
    std::vector<double> steps = run.steps();
    EXPECT_EQ(run.solution.work.rejected_steps, 0u);
    steps.pop_back();  // the last one may be shorter
    for (const double step : steps) EXPECT_GE(step, 0.25 - 1e-15);
  }
}

TEST(AdaptiveLoop, NeverExceedsTheMaximumStep) {
  // Steps of 1/8 from the start: what is left at the end is a little more or less than one, or anything.
  for (const double rest : {0.0, 0.0005, 0.0012, 0.02, 0.0625, 0.12, 0.1249}) {
    const WatchedRun run = solve("dormand_prince_54", circle(1.0 + rest),
                                 {.relative_tolerance = 1e-2,
                                  .absolute_tolerance = 1e-2,
                                  .initial_step = 0.125,
                                  .maximum_step = 0.125});
    ASSERT_TRUE(run.solution.status.ok());
    EXPECT_EQ(run.steps().front(), 0.125);
    EXPECT_LE(std::ranges::max(run.steps()), 0.125 * (1.0 + 1e-12)) << rest;
  }
}

TEST(AdaptiveLoop, TakesTheInitialStepThatIsGiven) {
  AdaptiveStep control{1e-6, 1e-9};
  control.initial_step = 1e-5;
  const std::vector<double> given = solve("dormand_prince_54", circle(1.0), control).steps();
  EXPECT_DOUBLE_EQ(given.front(), 1e-5);
  // Growth is limited to a factor of 5.
  EXPECT_LE(given[1], 5.0 * given[0] * (1.0 + 1e-12));
  control.initial_step = 100.0;  // far too long: rejected, not believed
  const WatchedRun long_run = solve("dormand_prince_54", circle(100.0), control);
  EXPECT_GT(long_run.solution.work.rejected_steps, 0u);
  EXPECT_LT(circle_error(long_run.solution.state, 100.0), 1e-3);
}

/// ẏ = (y₂, −y₁)/τ.
struct ScaledCircle {
  double time_scale;
  template <class S>
  void operator()(const S&, std::span<const S> y, std::span<S> dydt) const {
    dydt[0] = y[1] / time_scale;
    dydt[1] = -y[0] / time_scale;
  }
};

TEST(AdaptiveLoop, ChoosesAnInitialStepThatCostsFewAttemptsOnAnyScaleOfTime) {
  const auto run_at = [](double scale, double tolerance) {
    return solve("dormand_prince_54", problem(ScaledCircle{scale}, Vector{{1.0, 0.0}}, 20.0 * scale),
                 {tolerance, tolerance});
  };
  for (const double tolerance : {1e-3, 1e-6, 1e-9}) {
    const WatchedRun unit = run_at(1.0, tolerance);
    EXPECT_EQ(unit.solution.work.rejected_steps, 0u) << tolerance;
    EXPECT_GT(unit.steps().front(), 0.02 * unit.steps()[unit.steps().size() / 2]) << tolerance;
    for (const double scale : {1e-6, 1e6}) {
      // The formula is not free of units; what it misses, up to 10⁶ = 5^8.6, is made up for by factors of 5.
      const Work work = run_at(scale, tolerance).solution.work;
      EXPECT_LE(work.accepted_steps + work.rejected_steps, unit.solution.work.accepted_steps + 14) << scale;
    }
  }
}

TEST(AdaptiveLoop, CountsRejectedStepsAndEvaluations) {
  const Ivp ivp = problem(Pulse{}, Vector{{0.0}}, 2.0);
  AdaptiveStep control{1e-6, 1e-8};
  control.initial_step = 0.01;
  control.maximum_step = 0.2;  // else the pulse is stepped over
  const double pi = 3.14159265358979323846;
  const WatchedRun fsal = solve("dormand_prince_54", ivp, control);
  ASSERT_TRUE(fsal.solution.status.ok()) << fsal.solution.status.describe();
  EXPECT_NEAR(fsal.solution.state[0], std::sqrt(pi) / 100.0, 1e-6);
  const Work& work = fsal.solution.work;
  EXPECT_GT(work.rejected_steps, 0u);
  // The last slope of an accepted step is the first of the next, and a repeated attempt keeps its first
  // slope.
  EXPECT_EQ(work.rhs_evaluations, 1 + 6 * (work.accepted_steps + work.rejected_steps));
  const WatchedRun other = solve("cash_karp_54", ivp, control);
  EXPECT_GT(other.solution.work.rejected_steps, 0u);
  EXPECT_EQ(other.solution.work.rhs_evaluations,
            6 * other.solution.work.accepted_steps + 5 * other.solution.work.rejected_steps);
}

TEST(AdaptiveLoop, RecoversFromNaNInAStageByRejection) {
  AdaptiveStep control{1e-8, 1e-10};
  control.initial_step = 1.9;
  const WatchedRun run = solve("dormand_prince_54", problem(Draining{}, Vector{{1.0}}, 1.9), control);
  ASSERT_TRUE(run.solution.status.ok()) << run.solution.status.describe();
  EXPECT_GT(run.solution.work.rejected_steps, 0u);
  EXPECT_NEAR(run.solution.state[0], 0.0025, 1e-8);
}

TEST(AdaptiveLoop, EndsWithTheReasonWhereTheRightHandSideStaysNaN) {
  const WatchedRun later =
      solve("dormand_prince_54", problem(UndefinedLater{}, Vector{{0.0}}, 1.0), {1e-6, 1e-9});
  EXPECT_EQ(later.solution.status.code, StatusCode::step_too_small);
  EXPECT_NE(later.solution.status.message.find("not finite"), std::string::npos)
      << later.solution.status.message;
  EXPECT_NEAR(later.solution.time, 0.5, 1e-10);
  EXPECT_NEAR(later.solution.state[0], 0.5, 1e-10);
  Ivp at_once = problem(UndefinedLater{}, Vector{{0.0}}, 2.0);
  at_once.t0 = 1.0;
  const WatchedRun never = solve("dormand_prince_54", at_once, {1e-6, 1e-9});
  EXPECT_EQ(never.solution.status.code, StatusCode::step_too_small) << never.solution.status.describe();
  EXPECT_NE(never.solution.status.message.find("not finite"), std::string::npos)
      << never.solution.status.message;
  EXPECT_EQ(never.solution.time, 1.0);
  EXPECT_EQ(never.solution.work.accepted_steps, 0u);
}

/// The largest error of the dense output at a thousand places.
class FrameError final : public Observer {
 public:
  bool observe(const StepView& view) override {
    for (; view.index > 0 && next_ * spacing <= view.time; ++next_) {
      view.interpolate(next_ * spacing, frame_);
      largest_ = std::max(largest_, circle_error(frame_, next_ * spacing));
      ++frames;
    }
    return true;
  }
  double largest() const { return largest_; }
  int frames = 0;

 private:
  static constexpr double spacing = 0.01;
  int next_ = 0;
  Vector frame_ = Vector::Zero(2);
  double largest_ = 0.0;
};

TEST(AdaptiveLoop, GivesFramesBetweenTheStepsWithoutChangingThem) {
  // Of its own order 4 or cubic Hermite: what interpolation adds at this tolerance stays bounded.
  for (const char* name : {"dormand_prince_54", "bogacki_shampine_32", "cash_karp_54"}) {
    FrameError frames;
    const AdaptiveStep control{1e-8, 1e-8};
    const Solution solution = method(name)->solve(circle(10.0), control, frames);
    EXPECT_EQ(frames.frames, 1001) << name;
    EXPECT_LT(frames.largest(), std::string(name) == "cash_karp_54" ? 3e-5 : 3e-7) << name;
    EXPECT_GE(frames.largest(), circle_error(solution.state, 10.0) * 0.999) << name;
    EXPECT_EQ(solution.state, solve(name, circle(10.0), control).solution.state) << name;
  }
}

TEST(AdaptiveLoop, DenseOutputMeetsTheEndsOfItsStep) {
  class Ends final : public Observer {
   public:
    bool observe(const StepView& view) override {
      if (view.index > 0) {
        Vector value(2);
        view.interpolate(time_, value);
        largest = std::max(largest, (value - state_).norm());
        view.interpolate(view.time, value);
        largest = std::max(largest, (value - view.state).norm());
      }
      time_ = view.time;
      state_ = view.state;
      return true;
    }
    double largest = 0.0;

   private:
    double time_ = 0.0;
    Vector state_;
  };
  for (const char* name : {"dormand_prince_54", "tsitouras_54", "cash_karp_54"}) {
    Ends ends;
    method(name)->solve(circle(10.0), AdaptiveStep{1e-4, 1e-4}, ends);
    EXPECT_LT(ends.largest, 1e-14) << name;
  }
}

}  // namespace
}  // namespace fw::integrators
