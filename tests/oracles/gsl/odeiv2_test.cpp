#include "oracles/gsl/odeiv2.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <thread>

#include "analysis/reference/reference_solution.hpp"
#include "core/error.hpp"
#include "integrators/network.hpp"
#include "integrators/order_measurement.hpp"
#include "ode/functor_system.hpp"
#include "problems/stiff_equations.hpp"

namespace fw::oracles {
namespace {

using integrators::distance;
using integrators::driven_pair;
using integrators::extrapolated_end;

std::unique_ptr<Integrator> stepper(const std::string& name) {
  for (const GslStepper& known : gsl_steppers()) {
    if (known.name == name) return make_gsl_stepper(name, {.tolerance_factor = known.tolerance_factor});
  }
  throw std::logic_error("no stepper " + name);
}

Solution solve(const Integrator& integrator, const Ivp& ivp, const StepControl& control) {
  NullObserver observer;
  return integrator.solve(ivp, control, observer);
}

double error(const Solution& solution, const std::vector<Float128>& exact) {
  std::vector<Float128> state(exact.size());
  for (std::size_t i = 0; i < exact.size(); ++i) state[i] = solution.state[static_cast<Index>(i)];
  return distance(state, exact);
}

TEST(GslSteppers, ReachTheReferenceWithinTheirTolerances) {
  for (const double damping : {0.0, 0.5}) {
    const Ivp ivp = driven_pair(damping);
    const std::vector<Float128> exact = extrapolated_end(ivp);
    for (const GslStepper& known : gsl_steppers()) {
      SCOPED_TRACE(known.name);
      const auto integrator = stepper(known.name);
      // The first order ones would take millions of steps at the tolerances of the others.
      const double tolerance = integrator->info().order == 1   ? 1e-6
                               : integrator->info().order == 2 ? 1e-8
                                                               : 1e-10;
      const Solution solution =
          solve(*integrator, ivp,
                AdaptiveStep{.relative_tolerance = tolerance, .absolute_tolerance = tolerance * 1e-1});
      ASSERT_TRUE(solution.status.ok()) << solution.status.describe();
      EXPECT_EQ(solution.time, ivp.t1);
      // An error per step adds up over the steps: with order p there are tolerance^(-1/(p+1)) of them.
      const double steps = static_cast<double>(solution.work.accepted_steps);
      EXPECT_LT(error(solution, exact), tolerance * std::max(30.0, steps));
      EXPECT_GT(error(solution, exact), 0.0);
      EXPECT_EQ(solution.work.jacobian_evaluations > 0, !integrator->info().is_explicit);
    }
  }
}

TEST(GslSteppers, ShowTheirOrdersWithConstantSteps) {
  const Ivp ivp = driven_pair(0.5);
  const std::vector<Float128> exact = extrapolated_end(ivp);
  int measured = 0;
  for (const GslStepper& known : gsl_steppers()) {
    const auto integrator = stepper(known.name);
    if (!integrator->info().has_fixed_step) {
      EXPECT_THROW(solve(*integrator, ivp, FixedStep{.step = 0.1}), InputError);
      continue;
    }
    SCOPED_TRACE(known.name);
    const int order = integrator->info().order;
    const double fine = order >= 8 ? 1.0 / 16 : order >= 5 ? 1.0 / 64 : 1.0 / 256;
    const double coarse_error = error(solve(*integrator, ivp, FixedStep{.step = 2.0 * fine}), exact);
    const double fine_error = error(solve(*integrator, ivp, FixedStep{.step = fine}), exact);
    EXPECT_NEAR(std::log2(coarse_error / fine_error), order, order >= 8 ? 0.6 : 0.25);
    ++measured;
  }
  EXPECT_EQ(measured, 8);
}

TEST(GslSteppers, OfStepDoublingAreTwoHalfStepsOfOurSchemes) {
  const Ivp ivp = driven_pair(0.5);
  const auto ours = [](const std::string& name) {
    return name == "rk4"      ? integrators::explicit_runge_kutta("rk4")
           : name == "rk1imp" ? integrators::make_implicit_euler()
           : name == "rk2imp" ? integrators::make_diagonally_implicit_runge_kutta(integrators::named(
                                    schemes::diagonally_implicit_tableaus(), "implicit_midpoint"))
                              : integrators::make_fully_implicit_runge_kutta(
                                    integrators::named(schemes::fully_implicit_tableaus(), "gauss2"));
  };
  for (const char* name : {"rk4", "rk1imp", "rk2imp", "rk4imp"}) {
    SCOPED_TRACE(name);
    const double step = 1.0 / 32;
    const Solution theirs = solve(*stepper(name), ivp, FixedStep{.step = step});
    ASSERT_TRUE(theirs.status.ok()) << theirs.status.describe();
    const Solution own = solve(*ours(name), ivp, FixedStep{.step = 0.5 * step});
    EXPECT_LT((theirs.state - own.state).lpNorm<Eigen::Infinity>(), 1e-12);
    const Solution another = solve(*ours(name), ivp, FixedStep{.step = step});
    EXPECT_GT((theirs.state - another.state).lpNorm<Eigen::Infinity>(), 1e-10)
        << "the comparison sees nothing";
  }
}

TEST(GslSteppers, SolveStiffVanDerPolWithTheAnalyticJacobian) {
  Ivp ivp = problems::van_der_pol().ivp;
  ivp.t1 = 0.5;
  const Vector expected = analysis::certified_reference(ivp, ivp.t1).states.at(0).rounded();
  for (const char* name : {"bsimp", "msbdf", "rk4imp"}) {
    SCOPED_TRACE(name);
    const Solution solution =
        solve(*stepper(name), ivp, AdaptiveStep{.relative_tolerance = 1e-8, .absolute_tolerance = 1e-10});
    ASSERT_TRUE(solution.status.ok()) << solution.status.describe();
    EXPECT_LT((solution.state - expected).lpNorm<Eigen::Infinity>(), 1e-6);
    EXPECT_LT(solution.work.accepted_steps, 20'000u);
  }
}

/// f is NaN from t = 0.5 on.
struct BreaksDown {
  template <class S>
  void operator()(const S& t, std::span<const S> y, std::span<S> dydt) const {
    dydt[0] = real_part(t) < 0.5 ? -y[0] : S(std::numeric_limits<double>::quiet_NaN());
  }
};

struct Throws {
  template <class S>
  void operator()(const S& t, std::span<const S> y, std::span<S> dydt) const {
    if (real_part(t) > 0.5) throw std::runtime_error("the right-hand side gave up");
    dydt[0] = -y[0];
  }
};

Ivp one_equation(std::shared_ptr<const OdeSystem> system) {
  Ivp ivp;
  ivp.system = std::move(system);
  ivp.y0 = Vector{{1.0}};
  return ivp;
}

TEST(GslSteppers, EndInAStatusWhereTheRightHandSideBreaksDown) {
  const Ivp ivp = one_equation(std::make_shared<FunctorSystem<BreaksDown>>(1, BreaksDown{}));
  for (const GslStepper& known : gsl_steppers()) {
    SCOPED_TRACE(known.name);
    const Solution solution = solve(*stepper(known.name), ivp, AdaptiveStep{});
    EXPECT_EQ(solution.status.code, StatusCode::non_finite) << solution.status.describe();
    EXPECT_NE(solution.status.message.find("GSL " + known.name), std::string::npos)
        << solution.status.describe();
    EXPECT_TRUE(solution.state.allFinite());
    EXPECT_LE(solution.time, 0.5 + 1e-9);
  }
  const Solution constant = solve(*stepper("rk4"), ivp, FixedStep{.step = 0.1});
  EXPECT_EQ(constant.status.code, StatusCode::non_finite) << constant.status.describe();
}

TEST(GslSteppers, TakeTheConstantStepsTheyAreGivenOrFail) {
  const Ivp easy = driven_pair(0.5);
  for (const GslStepper& known : gsl_steppers()) {
    const auto integrator = stepper(known.name);
    if (!integrator->info().has_fixed_step) continue;
    SCOPED_TRACE(known.name);
    TrajectoryRecorder recorder;
    const double step = easy.t1 / 16;
    const Solution solution = integrator->solve(easy, FixedStep{.step = step}, recorder);
    ASSERT_TRUE(solution.status.ok()) << solution.status.describe();
    ASSERT_EQ(recorder.times().size(), 17u);
    for (std::size_t n = 0; n < 17; ++n)
      EXPECT_NEAR(recorder.times()[n], static_cast<double>(n) * step, 1e-14);
  }
  // Where the equations of a stage cannot be solved, GSL halves the step: that has to end the run.
  Ivp hard = problems::van_der_pol().ivp;
  hard.t1 = 100.0;
  for (const char* name : {"rk1imp", "rk2imp", "rk4imp"}) {
    SCOPED_TRACE(name);
    TrajectoryRecorder recorder;
    const Solution solution = stepper(name)->solve(hard, FixedStep{.step = 10.0}, recorder);
    if (solution.status.ok()) {
      EXPECT_EQ(solution.work.accepted_steps, 10u);
    } else {
      EXPECT_EQ(solution.status.code, StatusCode::newton_failed) << solution.status.describe();
    }
    for (std::size_t n = 0; n < recorder.times().size(); ++n)
      EXPECT_EQ(recorder.times()[n], 10.0 * static_cast<double>(n));
  }
}

TEST(GslSteppers, PassOnAnExceptionOfTheRightHandSide) {
  const Ivp ivp = one_equation(std::make_shared<FunctorSystem<Throws>>(1, Throws{}));
  for (const GslStepper& known : gsl_steppers()) {
    SCOPED_TRACE(known.name);
    EXPECT_THROW(solve(*stepper(known.name), ivp, AdaptiveStep{}), std::runtime_error);
  }
}

TEST(GslSteppers, RefuseWhatTheyCannotDo) {
  const Ivp ivp = driven_pair(0.0);
  EXPECT_THROW(solve(*stepper("rk4"), ivp, AdaptiveStep{.relative_tolerance = 0.0}), InputError);
  EXPECT_THROW(make_gsl_stepper("rk5", {}), InputError);
  const Solution solution = solve(*stepper("rkf45"), ivp, AdaptiveStep{.maximum_steps = 5});
  EXPECT_EQ(solution.status.code, StatusCode::step_limit);
}

TEST(GslSteppers, GiveTheSameBitsInEveryThread) {
  const Ivp ivp = driven_pair(0.5);
  const auto end = [&] { return solve(*stepper("msbdf"), ivp, AdaptiveStep{}).state; };
  const Vector expected = end();
  Vector first, second;
  std::thread one([&] { first = end(); });
  std::thread two([&] { second = end(); });
  one.join();
  two.join();
  EXPECT_EQ(first, expected);
  EXPECT_EQ(second, expected);
}

TEST(GslSteppers, RespectTheSmallestAndTheLargestStep) {
  const Ivp ivp = driven_pair(0.0);
  TrajectoryRecorder recorder;
  const Solution solution =
      stepper("rkf45")->solve(ivp, AdaptiveStep{.relative_tolerance = 1e-3, .maximum_step = 0.05}, recorder);
  ASSERT_TRUE(solution.status.ok());
  for (std::size_t k = 1; k < recorder.times().size(); ++k) {
    EXPECT_LT(recorder.times()[k] - recorder.times()[k - 1], 0.05 * (1 + 1e-12));
  }
  const Solution refused =
      solve(*stepper("rkf45"), ivp,
            AdaptiveStep{.relative_tolerance = 1e-10, .absolute_tolerance = 1e-12, .minimum_step = 0.5});
  EXPECT_EQ(refused.status.code, StatusCode::step_too_small);
}

}  // namespace
}  // namespace fw::oracles
