#include "oracles/sundials/cvode.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "integrators/network.hpp"
#include "ode/functor_system.hpp"
#include "problems/oscillators.hpp"
#include "problems/stiff_equations.hpp"
#include "reference_state.hpp"

namespace fw::oracles {
namespace {

using integrators::random_network;

TEST(CvodeBdf, AgreesWithTheCertifiedReferenceOnRandomNetworksOfEveryLaw) {
  NullObserver observer;
  for (auto law :
       {mechanics::SpringLaw::hooke, mechanics::SpringLaw::strain, mechanics::SpringLaw::tension_only}) {
    for (bool damped : {true, false}) {
      const Ivp ivp =
          random_network(31 + static_cast<std::uint64_t>(law), {.law = law, .is_damped = damped}, 1.5);
      const Solution solution = make_cvode_bdf()->solve(
          ivp, AdaptiveStep{.relative_tolerance = 1e-10, .absolute_tolerance = 1e-12}, observer);
      ASSERT_TRUE(solution.status.ok()) << solution.status.describe();
      EXPECT_EQ(solution.time, ivp.t1);
      const Index n = ivp.y0.size() / 2;
      EXPECT_LT((solution.state - reference_state(ivp)).head(n).lpNorm<Eigen::Infinity>(), 1e-7);
      const auto& fixed = ivp.system->second_order()->fixed();
      for (Index i = 0; i < n; ++i) {
        if (fixed[static_cast<std::size_t>(i)]) {
          EXPECT_EQ(solution.state[i], ivp.y0[i]);
        }
      }
    }
  }
}

TEST(CvodeBdf, CatchesAWrongSpringConstant) {
  // Negative control of the comparison above: a stiffness that is off by 1e-5 is seen.
  NullObserver observer;
  const Ivp ivp = random_network(31, {}, 1.5);
  mechanics::MassSpringModel model = dynamic_cast<const mechanics::MassSpringSystem&>(*ivp.system).model();
  model.springs.stiffness[3] *= 1.0 + 1e-5;
  Ivp wrong = ivp;
  wrong.system = std::make_shared<const mechanics::MassSpringSystem>(model);
  const Solution solution = make_cvode_bdf()->solve(
      wrong, AdaptiveStep{.relative_tolerance = 1e-10, .absolute_tolerance = 1e-12}, observer);
  const Index n = ivp.y0.size() / 2;
  EXPECT_GT((solution.state - reference_state(ivp)).head(n).lpNorm<Eigen::Infinity>(), 1e-7);
}

TEST(CvodeBdf, SolvesStiffVanDerPol) {
  const Problem problem = problems::van_der_pol();
  Ivp ivp = problem.ivp;
  ivp.t1 = 0.5;
  NullObserver observer;
  const Solution solution = make_cvode_bdf()->solve(
      ivp, AdaptiveStep{.relative_tolerance = 1e-9, .absolute_tolerance = 1e-11}, observer);
  ASSERT_TRUE(solution.status.ok()) << solution.status.describe();
  EXPECT_LT((solution.state - reference_state(ivp)).lpNorm<Eigen::Infinity>(), 1e-6);
  EXPECT_LT(solution.work.accepted_steps, 5000u);
  EXPECT_GT(solution.work.jacobian_evaluations, 0u);
}

TEST(CvodeBdf, InterpolatesBetweenItsSteps) {
  const Problem problem = problems::harmonic_oscillator();
  class Interpolation final : public Observer {
   public:
    explicit Interpolation(const Problem& p) : problem_(p), out_(2) {}
    bool observe(const StepView& view) override {
      if (view.index > 0) {
        const double middle = 0.5 * (previous_ + view.time);
        view.interpolate(middle, out_);
        largest_ = std::max(largest_, std::abs(out_[0] - static_cast<double>(problem_.exact(middle)[0])));
        ++count_;
      }
      previous_ = view.time;
      return true;
    }
    double largest() const { return largest_; }
    int count() const { return count_; }

   private:
    const Problem& problem_;
    Vector out_;
    double previous_ = 0.0, largest_ = 0.0;
    int count_ = 0;
  } observer(problem);
  const Solution solution = make_cvode_bdf()->solve(
      problem.ivp, AdaptiveStep{.relative_tolerance = 1e-10, .absolute_tolerance = 1e-12}, observer);
  ASSERT_TRUE(solution.status.ok());
  EXPECT_EQ(static_cast<std::uint64_t>(observer.count()), solution.work.accepted_steps);
  EXPECT_LT(observer.largest(), 1e-6);
}

/// f is NaN from t = 0.5 on.
struct BreaksDown {
  template <class S>
  void operator()(const S& t, std::span<const S> y, std::span<S> dydt) const {
    dydt[0] = real_part(t) < 0.5 ? -y[0] : S(std::numeric_limits<double>::quiet_NaN());
  }
};

TEST(CvodeBdf, ReportsItsOwnReasonWhereTheRightHandSideBreaksDown) {
  Ivp ivp;
  ivp.system = std::make_shared<FunctorSystem<BreaksDown>>(1, BreaksDown{});
  ivp.y0 = Vector{{1.0}};
  NullObserver observer;
  const Solution solution = make_cvode_bdf()->solve(ivp, AdaptiveStep{}, observer);
  EXPECT_EQ(solution.status.code, StatusCode::step_too_small) << solution.status.describe();
  EXPECT_NE(solution.status.message.find("CVODE at t = 0.5"), std::string::npos)
      << solution.status.describe();
  EXPECT_TRUE(solution.state.allFinite());
  EXPECT_GT(solution.time, 0.3);
  EXPECT_LE(solution.time, 0.5);
}

TEST(CvodeBdf, RefusesAFixedStepAndStopsAtItsLimitOfSteps) {
  const Problem problem = problems::harmonic_oscillator();
  NullObserver observer;
  EXPECT_THROW(make_cvode_bdf()->solve(problem.ivp, FixedStep{.step = 0.1}, observer), InputError);
  EXPECT_THROW(make_cvode_bdf()->solve(problem.ivp, AdaptiveStep{.relative_tolerance = 0.0}, observer),
               InputError);
  const Solution solution = make_cvode_bdf()->solve(problem.ivp, AdaptiveStep{.maximum_steps = 5}, observer);
  EXPECT_EQ(solution.status.code, StatusCode::step_limit);
}

TEST(CvodeBdf, GivesTheSameBitsWhenRunTwice) {
  const Ivp ivp = random_network(33, {}, 1.0);
  NullObserver observer;
  const auto end = [&] { return make_cvode_bdf()->solve(ivp, AdaptiveStep{}, observer).state; };
  EXPECT_EQ(end(), end());
}

}  // namespace
}  // namespace fw::oracles
