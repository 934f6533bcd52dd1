#include "integrators/tableau/runge_kutta_chebyshev.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "network.hpp"
#include "order_measurement.hpp"
#include "schemes/chebyshev_recurrence.hpp"
#include "schemes/order_conditions.hpp"

namespace fw::integrators {
namespace {

std::unique_ptr<Integrator> chebyshev(int order, int stages) {
  return make_runge_kutta_chebyshev({.order = order, .stages = stages});
}

/// Decay with three rates, two of them fast.
struct Decay {
  double rate = 0.0;

  template <class S>
  void operator()(const S&, std::span<const S> y, std::span<S> dydt) const {
    dydt[0] = -y[0];
    dydt[1] = S(-rate) * y[1];
    dydt[2] = S(-0.5 * rate) * y[2];
  }
};

Ivp decay(double rate, double end) {
  Ivp ivp;
  ivp.system = std::make_shared<FunctorSystem<Decay>>(3, Decay{rate});
  ivp.y0 = Vector{{1.0, 1.0, 1.0}};
  ivp.t1 = end;
  return ivp;
}

TEST(RungeKuttaChebyshev, HasTheOrderThatItClaimsWithAnyNumberOfStages) {
  const Ivp ivp = driven_pair(0.375);
  const std::vector<Float128> reference = extrapolated_end(ivp);
  for (const int order : {1, 2}) {
    for (const int stages : {2, 3, 8, 15}) {
      const auto integrator = chebyshev(order, stages);
      EXPECT_EQ(integrator->info().order, order);
      expect_order(*integrator, ivp, reference, order);
    }
  }
}

TEST(RungeKuttaChebyshev, AgreesInDoubleAndInBinary128) {
  const Ivp ivp = driven_pair(0.375);
  for (const int order : {1, 2}) {
    for (const int stages : {2, 8, 30}) {
      const auto integrator = chebyshev(order, stages);
      const Solution solution = run(*integrator, ivp, ivp.t1 / 40.0);
      const std::vector<Float128> extended = integrator->extended_solver()(ivp, 40);
      for (Index k = 0; k < 4; ++k) {
        EXPECT_NEAR(solution.state[k], static_cast<double>(extended[static_cast<std::size_t>(k)]), 1e-13);
      }
    }
  }
}

TEST(RungeKuttaChebyshev, IsTheTableauThatItIsDerivedFrom) {
  const Ivp ivp = driven_pair(0.375);
  for (const int order : {1, 2}) {
    const auto by_tableau = make_explicit_runge_kutta(schemes::chebyshev_tableau(order, 8));
    EXPECT_LT(
        distance(by_tableau->extended_solver()(ivp, 16), chebyshev(order, 8)->extended_solver()(ivp, 16)),
        1e-31);
  }
}

TEST(RungeKuttaChebyshev, IsStableOnTheWholeIntervalThatItClaimsAndNotMuchFurther) {
  for (const int order : {1, 2}) {
    for (const int stages : {2, 5, 8, 20}) {
      const double interval = schemes::real_stability_interval(order, stages);
      const auto after_200_steps = [&](double fraction) {
        return run(*chebyshev(order, stages), decay(fraction * interval, 200.0), 1.0);
      };
      for (const double fraction : {0.1, 0.5, 0.8, 0.97}) {
        const Solution solution = after_200_steps(fraction);
        ASSERT_TRUE(solution.status.ok());
        EXPECT_LT(std::abs(solution.state[1]), 1e-2) << order << ' ' << stages << ' ' << fraction;
      }
      const Solution beyond = after_200_steps(1.08);
      EXPECT_TRUE(!beyond.status.ok() || std::abs(beyond.state[1]) > 1e6) << order << ' ' << stages;
    }
  }
}

TEST(RungeKuttaChebyshev, TakesTheStagesThatTheSpectralRadiusAsksFor) {
  for (const int order : {1, 2}) {
    for (const double rate : {1.0, 40.0, 2000.0}) {
      const Ivp ivp = decay(rate, 50.0);
      const Solution solution = run(*chebyshev(order, 0), ivp, 1.0);
      ASSERT_TRUE(solution.status.ok()) << solution.status.describe();
      const auto stages = static_cast<int>(solution.work.rhs_evaluations / 50);
      EXPECT_EQ(solution.work.rhs_evaluations % 50, 0u);
      EXPECT_GE(schemes::real_stability_interval(order, stages), rate);
      if (stages > fewest_chebyshev_stages) {
        EXPECT_LT(schemes::real_stability_interval(order, stages - 1), 1.2 * rate);
      }
      // On its interval the method damps by 5 % a step at least (1 − ε, and 1 − ε/3 for order 2): 0.95⁵⁰ =
      // 0.077.
      EXPECT_LT(std::abs(solution.state[1]), 0.08);
      EXPECT_GT(solution.work.jacobian_products, 0u);
    }
  }
}

TEST(RungeKuttaChebyshev, TakesStepsOfADampedNetworkThatExplicitEulerCannot) {
  // A chain of masses with dampers a thousand times as strong as its springs.
  mechanics::MassSpringModel model;
  Ivp ivp;
  const int n = 6;
  ivp.y0 = Vector::Zero(6 * n);
  for (int i = 0; i < n; ++i) {
    model.mass.push_back(0.5);
    ivp.y0[3 * i] = i;
    ivp.y0[3 * n + 3 * i] = 0.1 * i;
  }
  mechanics::RandomModels random(5);
  for (int i = 0; i + 1 < n; ++i) {
    random.add_spring(model.springs, i, i + 1, true);
    model.springs.stiffness.back() = 1.0;
    model.springs.damping.back() = 1000.0;
    model.springs.rest_length.back() = 1.0;
  }
  ivp.system = std::make_shared<const mechanics::MassSpringSystem>(std::move(model));
  ivp.t1 = 2.0;
  const double h = 0.02;  // h ϱ(J) ≈ 150
  EXPECT_FALSE(run(*explicit_runge_kutta("explicit_euler"), ivp, h).status.ok());
  const Solution solution = run(*chebyshev(2, 0), ivp, h);
  ASSERT_TRUE(solution.status.ok()) << solution.status.describe();
  const Solution fine = run(*explicit_runge_kutta("rk4"), ivp, 1e-4);
  EXPECT_LT((solution.state - fine.state).lpNorm<Eigen::Infinity>(), 2e-3);
}

TEST(RungeKuttaChebyshev, SaysWhereTooManyStagesWouldBeNeeded) {
  const Solution solution = run(*chebyshev(2, 0), decay(1e9, 2.0), 1.0);
  EXPECT_EQ(solution.status.code, StatusCode::step_limit);
  EXPECT_NE(solution.status.message.find("stages"), std::string::npos);
}

TEST(RungeKuttaChebyshev, RefusesTooFewStages) {
  EXPECT_THROW(schemes::chebyshev_tableau(2, 1), std::logic_error);
  EXPECT_THROW(schemes::chebyshev_tableau(3, 5), std::logic_error);
  EXPECT_EQ(schemes::order_of_accuracy(schemes::chebyshev_tableau(1, 1)), 1);
}

}  // namespace
}  // namespace fw::integrators
