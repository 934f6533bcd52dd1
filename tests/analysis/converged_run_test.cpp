#include "analysis/reference/converged_run.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "integrators/network.hpp"
#include "integrators/order_measurement.hpp"
#include "problems/oscillators.hpp"

namespace fw::analysis {
namespace {

using integrators::driven_pair;

double largest(ConstVectorRef difference) {
  return difference.lpNorm<Eigen::Infinity>();
}

TEST(ConvergedRun, BoundsItsErrorWithConstantStepsAndWithTolerances) {
  const Ivp ivp = driven_pair(0.5);
  const std::vector<Float128> exact = integrators::extrapolated_end(ivp);
  Vector expected(ivp.y0.size());
  for (Index i = 0; i < expected.size(); ++i)
    expected[i] = static_cast<double>(exact[static_cast<std::size_t>(i)]);
  for (const char* name : {"explicit_euler", "heun", "rk4", "dormand_prince_54", "fehlberg_54"}) {
    for (bool constant : {true, false}) {
      SCOPED_TRACE(name);
      const auto scheme = integrators::explicit_runge_kutta(name);
      const ConvergedRun run =
          run_to_accuracy(*scheme, ivp, largest, {.error = 1e-7, .most_steps = 2048}, constant);
      ASSERT_TRUE(run.status.ok()) << run.status.describe();
      const double error = largest(run.state - expected);
      EXPECT_LE(error, 1.05 * run.error_estimate);
      EXPECT_GT(error, 1e-3 * run.error_estimate) << "the estimate says nothing";
      if (scheme->info().order >= 4) {
        EXPECT_LE(run.error_estimate, 1e-7);
      }
      EXPECT_EQ(run.step > 0.0, run.tolerance == 0.0);
    }
  }
}

TEST(ConvergedRun, IsNotFooledByAnErrorEstimateThatIsBlind) {
  // ROS3P and its embedded solution have the same stability function: on a linear system it never rejects.
  const Problem problem = problems::damped_oscillator();
  const auto ros3p =
      integrators::make_rosenbrock(integrators::named(schemes::rosenbrock_tableaus(), "ros3p"));
  NullObserver observer;
  const Solution blind = ros3p->solve(
      problem.ivp, AdaptiveStep{.relative_tolerance = 1e-12, .absolute_tolerance = 1e-14}, observer);
  Vector exact(2);
  for (Index i = 0; i < 2; ++i) {
    exact[i] = static_cast<double>(problem.exact(problem.ivp.t1)[static_cast<std::size_t>(i)]);
  }
  ASSERT_GT(largest(blind.state - exact), 1e-2) << "it is not blind any more";
  const ConvergedRun adaptive = run_to_accuracy(*ros3p, problem.ivp, largest, {.error = 1e-7});
  EXPECT_LT(adaptive.error_estimate, 1e-4);
  EXPECT_LE(largest(adaptive.state - exact), adaptive.error_estimate);
  const ConvergedRun constant = run_to_accuracy(*ros3p, problem.ivp, largest, {.error = 1e-6}, true);
  EXPECT_LE(constant.error_estimate, 1e-6);
}

TEST(ConvergedRun, EndsWithTheReasonWhereEveryRunFails) {
  Ivp ivp = problems::harmonic_oscillator({{"stiffness", 1e8}}).ivp;
  const ConvergedRun run = run_to_accuracy(*integrators::explicit_runge_kutta("rk4"), ivp, largest,
                                           {.error = 1e-6, .most_steps = 256}, true);
  EXPECT_EQ(run.state.size(), 0);
  EXPECT_TRUE(std::isinf(run.error_estimate));
  EXPECT_FALSE(run.status.ok());
}

TEST(ConvergedRun, SpendsNoMoreThanItsBudget) {
  const Ivp ivp = driven_pair(0.5);
  const ConvergedRun fixed = run_to_accuracy(*integrators::explicit_runge_kutta("explicit_euler"), ivp,
                                             largest, {.error = 1e-12, .most_steps = 128}, true);
  EXPECT_EQ(fixed.work.accepted_steps, 128u);
  const ConvergedRun adaptive = run_to_accuracy(*integrators::explicit_runge_kutta("bogacki_shampine_32"),
                                                ivp, largest, {.error = 1e-14, .most_steps = 32});
  EXPECT_EQ(adaptive.status.code, StatusCode::step_limit);
  EXPECT_LE(adaptive.work.accepted_steps, 16u * 32u);
}

TEST(ConvergedRun, StopsWhenItIsInterrupted) {
  std::atomic<bool> asked{false};
  const auto stop_after_the_second_run = [&](ConstVectorRef difference) {
    asked = true;
    return largest(difference);
  };
  const ConvergedRun run =
      run_to_accuracy(*integrators::explicit_runge_kutta("rk4"), driven_pair(0.5), stop_after_the_second_run,
                      {.error = 1e-14, .fewest_steps = 16, .stop = StopToken(asked)}, true);
  EXPECT_EQ(run.status.code, StatusCode::interrupted);
  EXPECT_EQ(run.work.accepted_steps, 32u);  // what was finished before is kept
}

}  // namespace
}  // namespace fw::analysis
