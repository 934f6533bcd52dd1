#include "integrators/loop/progress_watch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "ode/functor_system.hpp"

namespace fw::integrators {
namespace {

/// ÿ = −ω² y + a sin(Ω t).
struct Driven {
  double omega = 1.0, amplitude = 0.0, frequency = 0.0;
  template <class S>
  void operator()(const S& t, std::span<const S> y, std::span<S> dydt) const {
    using std::sin;
    dydt[0] = y[1];
    dydt[1] = S(-omega * omega) * y[0] + S(amplitude) * sin(S(frequency) * t);
  }
};

Ivp problem(const Driven& driven, double t1) {
  Ivp ivp;
  ivp.system = std::make_shared<FunctorSystem<Driven>>(2, driven);
  ivp.y0 = Vector{{1.0, 0.0}};
  ivp.t1 = t1;
  return ivp;
}

/// The code with which a run ends that takes `count` steps of h(k) along the exact motion of ω = 1.
StatusCode judged(const Ivp& ivp, const AdaptiveStep& tolerances, int count,
                  const std::function<double(int)>& h) {
  const MethodInfo info{.order = 5, .embedded_order = 4};
  ProgressWatch watch(info, ivp, &tolerances);
  double t = 0.0;
  const auto state = [](double time) { return Vector{{std::cos(time), -std::sin(time)}}; };
  for (int k = 0; k < count; ++k) {
    LoopStep step{.start = t, .end = t + h(k), .is_accepted = true};
    if (const Status status = watch.judge(step, state(step.start), state(step.end)); !status.ok()) {
      EXPECT_GE(k, 19);
      return status.code;
    }
    t = step.end;
  }
  return StatusCode::success;
}

const AdaptiveStep usual{.relative_tolerance = 1e-6, .absolute_tolerance = 1e-9};

TEST(ProgressWatch, EndsRunsWhoseStepsNothingAsksFor) {
  EXPECT_EQ(judged(problem({}, 1.0), usual, 10'000, [](int) { return 1e-9; }), StatusCode::no_progress);
}

TEST(ProgressWatch, LeavesRunsAloneThatAreSlowForAReason) {
  const auto tiny = [](int) { return 1e-9; };
  const auto run = [&](const Driven& driven, double t1, const AdaptiveStep& tolerances) {
    return judged(problem(driven, t1), tolerances, 10'000, tiny);
  };
  // Few steps to go, a stiff system, a fast force, a tolerance that needs it, the user's longest step.
  EXPECT_EQ(run({}, 2e-5, usual), StatusCode::success);
  EXPECT_EQ(run({.omega = 1e7}, 1.0, usual), StatusCode::success);
  EXPECT_EQ(run({.amplitude = 10.0, .frequency = 1e8}, 1.0, usual), StatusCode::success);
  EXPECT_EQ(run({}, 1.0, {.relative_tolerance = 1e-6, .absolute_tolerance = 1e-40}), StatusCode::success);
  AdaptiveStep limited = usual;
  limited.maximum_step = 1e-9;
  EXPECT_EQ(run({}, 1.0, limited), StatusCode::success);
  // Steps that recover.
  const auto grows = [](int k) { return 1e-12 * std::exp(6e-4 * k); };
  EXPECT_EQ(judged(problem({}, 1.0), usual, 10'000, grows), StatusCode::success);
}

TEST(ProgressWatch, EndsRunsThatStandStill) {
  EXPECT_EQ(judged(problem({}, 1.0), usual, 100, [](int) { return 0.0; }), StatusCode::step_too_small);
}

}  // namespace
}  // namespace fw::integrators
