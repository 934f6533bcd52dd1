#include "integrators/loop/side_steps.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "integrators/saved_run.hpp"
#include "integrators/tableau/explicit_runge_kutta.hpp"
#include "ode/functor_system.hpp"
#include "schemes/explicit_tableaus.hpp"

namespace fw::integrators {
namespace {

/// (cos t, sin t) and an unknown that rests.
struct Circle {
  template <class S>
  void operator()(const S&, std::span<const S> y, std::span<S> dydt) const {
    dydt[0] = -y[1];
    dydt[1] = y[0];
    dydt[2] = S(0);
  }
};

Vector on_circle(double t) {
  return Vector{{std::cos(t), std::sin(t), 0.1}};
}

/// Dense output over a step of length h along the circle whose side steps are exact.
struct ExactStep {
  explicit ExactStep(double h, int nodes)
      : end(h),
        last(on_circle(h)),
        inside(
            system, nodes,
            [this](double, double t_end, ConstVectorRef, VectorRef out) {
              ++side_steps;
              out = on_circle(t_end);
              return Status{};
            },
            work) {
    inside.set_step(0.0, end, first, last);
  }
  double error(double theta) {
    Vector y(3);
    inside(theta * end, y);
    return (y - on_circle(theta * end)).lpNorm<Eigen::Infinity>();
  }

  FunctorSystem<Circle> system{3, Circle{}};
  Work work;
  int side_steps = 0;
  double end;
  Vector first = on_circle(0.0), last;
  SideSteps inside;
};

TEST(SideSteps, GiveTheEndsOfTheStepToTheLastBit) {
  for (const int nodes : {0, 2}) {
    ExactStep step(0.7, nodes);
    Vector y(3);
    step.inside(0.0, y);
    EXPECT_TRUE(same_bits(y, step.first));
    step.inside(0.7, y);
    EXPECT_TRUE(same_bits(y, step.last));
    EXPECT_EQ(step.side_steps, 0);
  }
}

/// |y − p| ≤ max|y^(n)|/n! h^n max ∏(θ − θ_i)², n = 2m + 4: the error falls by 2^n with the step.
TEST(SideSteps, PolynomialsThroughMNodesErrOfOrderTwoMPlusFour) {
  for (const int nodes : {1, 2, 3}) {
    const double h = nodes == 3 ? 2.0 : 1.0;
    double coarse = 0.0, fine = 0.0;
    ExactStep long_step(h, nodes), short_step(0.5 * h, nodes);
    for (double theta = 0.05; theta < 1.0; theta += 0.05) {
      coarse = std::max(coarse, long_step.error(theta));
      fine = std::max(fine, short_step.error(theta));
    }
    EXPECT_NEAR(std::log2(coarse / fine), 2 * nodes + 4, 0.3) << nodes;
    EXPECT_EQ(long_step.side_steps, nodes);  // once for all places
    EXPECT_EQ(long_step.work.rhs_evaluations, static_cast<std::uint64_t>(nodes + 2));
  }
}

TEST(SideSteps, LetAComponentRestThatRestsAtAllPlaces) {
  ExactStep step(0.7, 3);
  Vector y(3);
  for (double theta = 0.1; theta < 1.0; theta += 0.1) {
    step.inside(theta * 0.7, y);
    EXPECT_EQ(y[2], 0.1);
  }
}

TEST(SideSteps, AreTriedInPartsAndThenNotKnown) {
  FunctorSystem<Circle> system{3, Circle{}};
  Work work;
  double longest = 0.0;  // that succeeds
  int calls = 0;
  SideSteps inside(
      system, 0,
      [&](double t, double t_end, ConstVectorRef y, VectorRef out) -> Status {
        ++calls;
        if (t_end - t > longest) return {StatusCode::newton_failed, ""};
        const double angle = t_end - t;
        out = y;
        out[0] = std::cos(angle) * y[0] - std::sin(angle) * y[1];
        out[1] = std::sin(angle) * y[0] + std::cos(angle) * y[1];
        return {};
      },
      work);
  const Vector first = on_circle(0.0), last = on_circle(1.0);
  inside.set_step(0.0, 1.0, first, last);
  Vector y(3);
  longest = 0.13;
  inside(0.5, y);
  EXPECT_LT((y - on_circle(0.5)).norm(), 1e-15);
  EXPECT_EQ(calls, 1 + 1 + 4);  // 0.5, 0.25, then four of 0.125
  longest = 0.0;
  inside(0.5, y);
  EXPECT_TRUE(y.array().isNaN().all());
}

/// Weights of order 4 that are right, y = y_0 + h ∑ θ^k y^(k)/k! up to k = 4, raised to order 5.
TEST(SideSteps, RaiseContinuousWeightsByAnOrder) {
  class Taylor final : public ContinuousExtension {
   public:
    bool has_continuous_weights() const override { return true; }
    void extend(double theta, double h, ConstVectorRef, VectorRef out) override {
      const double z = theta * h;
      out = Vector{{1.0 - z * z / 2.0 + z * z * z * z / 24.0, z - z * z * z / 6.0, 0.1}};
    }
  } taylor;
  FunctorSystem<Circle> system{3, Circle{}};
  std::vector<double> errors;
  for (const double h : {0.5, 0.25}) {
    Work work;
    SideSteps inside(
        system, 1,
        [](double, double, ConstVectorRef, VectorRef) -> Status {
          ADD_FAILURE() << "a side step where none is needed";
          return {};
        },
        work, &taylor);
    const Vector first = on_circle(0.0), last = on_circle(h);
    inside.set_step(0.0, h, first, last);
    double largest = 0.0;
    Vector y(3);
    for (double theta = 0.05; theta < 1.0; theta += 0.05) {
      inside(theta * h, y);
      largest = std::max(largest, (y - on_circle(theta * h)).lpNorm<Eigen::Infinity>());
      EXPECT_EQ(y[2], 0.1);
    }
    errors.push_back(largest);
    EXPECT_EQ(work.rhs_evaluations, 4u);
  }
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 6.0, 0.3);
}

TEST(SlopePolynomial, IsExactForPolynomialsOfDegreeFive) {
  for (int degree = 0; degree <= 5; ++degree) {
    for (const double theta : {0.07, 0.31, 0.5, 0.77, 1.0}) {
      const SlopePolynomial::Weights weights = SlopePolynomial::weights(theta);
      double value = degree == 0 ? 0.0 : weights.end;  // p - p(0)
      for (std::size_t i = 0; i < 4; ++i) {
        const double place = SlopePolynomial::places()[i];
        value += degree == 0 ? 0.0 : weights.slopes[i] * degree * std::pow(place, degree - 1);
      }
      EXPECT_NEAR(value, degree == 0 ? 0.0 : std::pow(theta, degree), 1e-14) << degree << ' ' << theta;
    }
  }
}

/// A polynomial whose side step fails is none: what side steps can reach is reached by them.
TEST(SideSteps, GoWithoutThePolynomialWhereANodeIsNotReached) {
  FunctorSystem<Circle> system{3, Circle{}};
  Work work;
  SideSteps inside(
      system, 2,
      [&](double, double t_end, ConstVectorRef, VectorRef out) -> Status {
        if (t_end > 0.6) return {StatusCode::non_finite, ""};
        out = on_circle(t_end);
        return {};
      },
      work);
  const Vector first = on_circle(0.0), last = on_circle(1.0);
  inside.set_step(0.0, 1.0, first, last);
  Vector y(3);
  inside(0.5, y);
  EXPECT_TRUE(same_bits(y, on_circle(0.5)));
  inside(0.7, y);
  EXPECT_TRUE(std::isnan(y[0]));
}

/// Frames in every step of a run leave its steps as they are, bit for bit, also those of its counters that
/// count steps.
TEST(SideSteps, LeaveTheStepsOfTheRunAlone) {
  for (const auto& tableau : schemes::explicit_tableaus()) {
    if (tableau.b_embedded.empty()) continue;
    const auto method = make_explicit_runge_kutta(tableau, {});
    const Ivp ivp{std::make_shared<FunctorSystem<Circle>>(3, Circle{}), 0.0, 6.0, on_circle(0.0), {}};
    TrajectoryRecorder alone;
    StepRecord with_frames;
    const AdaptiveStep control{.relative_tolerance = 1e-7, .absolute_tolerance = 1e-7};
    const Solution a = method->solve(ivp, control, alone), b = method->solve(ivp, control, with_frames);
    ASSERT_EQ(alone.times(), with_frames.times) << tableau.name;
    for (std::size_t k = 0; k < alone.states().size(); ++k) {
      EXPECT_TRUE(same_bits(alone.states()[k], with_frames.states[k])) << tableau.name << ' ' << k;
    }
    EXPECT_EQ(a.work.accepted_steps, b.work.accepted_steps);
    EXPECT_EQ(a.work.rejected_steps, b.work.rejected_steps);
    EXPECT_GT(b.work.rhs_evaluations, a.work.rhs_evaluations);
  }
}

}  // namespace
}  // namespace fw::integrators
