#include "oracles/sundials/ida.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"
#include "failing_systems.hpp"
#include "integrators/network.hpp"
#include "oracles/sundials/ida_memory.hpp"
#include "problems/oscillators.hpp"
#include "problems/stiff_equations.hpp"
#include "reference_state.hpp"

namespace fw::oracles {
namespace {

using integrators::random_network;

constexpr AdaptiveStep tight_ida{.relative_tolerance = 1e-10, .absolute_tolerance = 1e-12};

TEST(Ida, AgreesWithTheCertifiedReferenceOnRandomNetworks) {
  NullObserver observer;
  for (const bool damped : {true, false}) {
    const Ivp ivp = random_network(41, {.is_damped = damped}, 1.5);
    const Solution solution = make_ida()->solve(ivp, tight_ida, observer);
    ASSERT_TRUE(solution.status.ok()) << solution.status.describe();
    EXPECT_EQ(solution.time, ivp.t1);
    const double error = (solution.state - reference_state(ivp)).lpNorm<Eigen::Infinity>();
    EXPECT_LT(error, 1e-7);
    RecordProperty(damped ? "damped" : "undamped", std::to_string(error * 1e10));
    EXPECT_GT(solution.work.jacobian_evaluations, 0u);
    EXPECT_GT(solution.work.factorisations, 0u);
    EXPECT_GT(solution.work.rhs_evaluations, solution.work.accepted_steps);
  }
}

TEST(Ida, SolvesStiffVanDerPolAsAFirstOrderSystem) {
  Ivp ivp = problems::van_der_pol().ivp;
  ivp.t1 = 0.5;
  NullObserver observer;
  const Solution solution =
      make_ida()->solve(ivp, AdaptiveStep{.relative_tolerance = 1e-9, .absolute_tolerance = 1e-11}, observer);
  ASSERT_TRUE(solution.status.ok()) << solution.status.describe();
  EXPECT_LT((solution.state - reference_state(ivp)).lpNorm<Eigen::Infinity>(), 1e-6);
}

TEST(Ida, InterpolatesBetweenItsSteps) {
  const Problem problem = problems::harmonic_oscillator();
  class Interpolation final : public Observer {
   public:
    explicit Interpolation(const Problem& p) : problem_(p) {}
    bool observe(const StepView& view) override {
      if (view.index > 0) {
        Vector out(2);
        const double middle = 0.5 * (previous_ + view.time);
        view.interpolate(middle, out);
        largest = std::max(largest, std::abs(out[0] - static_cast<double>(problem_.exact(middle)[0])));
      }
      previous_ = view.time;
      return true;
    }
    double largest = 0.0;

   private:
    const Problem& problem_;
    double previous_ = 0.0;
  } observer(problem);
  ASSERT_TRUE(make_ida()->solve(problem.ivp, tight_ida, observer).status.ok());
  EXPECT_LT(observer.largest, 1e-6);
  EXPECT_GT(observer.largest, 0.0);
}

TEST(Ida, HasTheJacobianOfItsResidual) {
  const Ivp ivp = random_network(42, {.is_damped = true}, 1.0);
  mechanics::RandomModels random(43);
  const Vector slope = random.vector(ivp.y0.size(), 1.0);
  constexpr double cj = 5.3, h = 1e-5;
  const auto form = detail::make_residual_form(*ivp.system);
  const Matrix J = form->jacobian(0.0, cj, ivp.y0);
  for (Index k = 0; k < ivp.y0.size(); ++k) {
    const auto residual = [&](double step) {
      Vector value(ivp.y0.size()), moved = ivp.y0, rate = slope;
      moved[k] += step;
      rate[k] += cj * step;
      form->residual(0.0, moved, rate, value);
      return value;
    };
    const Vector difference = (residual(h) - residual(-h)) / (2.0 * h);
    EXPECT_LE((J.col(k) - difference).lpNorm<Eigen::Infinity>(), 1e-6 * J.lpNorm<Eigen::Infinity>());
  }
}

TEST(Ida, GivesItsReasonWhereTheRightHandSideIsNoNumber) {
  NullObserver observer;
  const Solution solution = make_ida()->solve(scalar_problem(BecomesNaN{}), AdaptiveStep{}, observer);
  EXPECT_EQ(solution.status.code, StatusCode::non_finite) << solution.status.describe();
  EXPECT_NE(solution.status.message.find("IDA at t = 0."), std::string::npos) << solution.status.describe();
  EXPECT_NE(solution.status.message.find("not finite"), std::string::npos) << solution.status.describe();
  EXPECT_TRUE(solution.state.allFinite());
  EXPECT_GT(solution.time, 0.3);
  EXPECT_LE(solution.time, 0.5);
}

TEST(Ida, HandsOnAnExceptionOfTheRightHandSide) {
  NullObserver observer;
  EXPECT_THROW(make_ida()->solve(scalar_problem(Throws{}), AdaptiveStep{}, observer), std::runtime_error);
}

TEST(Ida, GivesItsReasonWhereNewtonDiverges) {
  NullObserver observer;
  const Solution solution = make_ida()->solve(
      scalar_problem(MisledNewton{}), AdaptiveStep{.initial_step = 0.1, .minimum_step = 0.05}, observer);
  EXPECT_EQ(solution.status.code, StatusCode::newton_failed) << solution.status.describe();
  EXPECT_NE(solution.status.message.find("IDA_CONV_FAIL"), std::string::npos) << solution.status.describe();
}

TEST(Ida, StopsAtABlowUpAndAtItsLimitOfSteps) {
  NullObserver observer;
  const Solution solution = make_ida()->solve(scalar_problem(BlowsUp{}), AdaptiveStep{}, observer);
  EXPECT_FALSE(solution.status.ok());
  EXPECT_LT(solution.time, 1.01);
  const Solution limited =
      make_ida()->solve(scalar_problem(BlowsUp{}), AdaptiveStep{.maximum_steps = 7}, observer);
  EXPECT_EQ(limited.status.code, StatusCode::step_limit);
  EXPECT_EQ(limited.work.accepted_steps, 7u);
  EXPECT_THROW(make_ida()->solve(scalar_problem(BlowsUp{}), FixedStep{.step = 0.1}, observer), InputError);
}

/// y₁' = −y₁ twice: the second unknown occurs nowhere.
class SingularForm final : public detail::DaeForm {
 public:
  SingularForm() : matrix_(2, 2) {
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) matrix_.insert(i, j) = 0.0;
    }
    matrix_.makeCompressed();
  }
  Index size() const override { return 2; }
  void residual(double t, ConstVectorRef y, ConstVectorRef dydt, VectorRef residual) override {
    residual[0] = residual[1] = dydt[0] + y[0] + 0.1 * std::sin(t);
  }
  const SparseMatrix& pattern() const override { return matrix_; }
  const SparseMatrix& jacobian(double, double cj, ConstVectorRef) override {
    matrix_.coeffRef(0, 0) = matrix_.coeffRef(1, 0) = cj + 1.0;
    return matrix_;
  }

 private:
  SparseMatrix matrix_;
};

TEST(Ida, GivesItsReasonWhereTheMatrixIsSingular) {
  Work work;
  detail::IdaMemory ida(std::make_unique<SingularForm>(), 0.0, 1.0, Vector{{1.0, 0.0}}, Vector{{-1.0, 0.0}},
                        AdaptiveStep{}, work);
  double t = 0.0;
  const Status status = ida.advance(1.0, t);
  EXPECT_EQ(status.code, StatusCode::matrix_singular) << status.describe();
  EXPECT_NE(status.message.find("IDA_"), std::string::npos) << status.describe();
}

TEST(Ida, GivesTheSameBitsWhenRunTwice) {
  const Ivp ivp = random_network(33, {}, 1.0);
  NullObserver observer;
  const auto end = [&] { return make_ida()->solve(ivp, AdaptiveStep{}, observer).state; };
  EXPECT_EQ(end(), end());
}

}  // namespace
}  // namespace fw::oracles
