#include "oracles/petsc/time_steppers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>
#include <thread>

#include "core/error.hpp"
#include "ode/functor_system.hpp"
#include "problems/cloth.hpp"
#include "ts_runs.hpp"

namespace fw::oracles {
namespace {

using testing::HasSubstr;

/// Error at the end over the tolerance that was asked for.
TEST(PetscTs, MeetsItsTolerance) {
  struct Case {
    std::unique_ptr<Integrator> method;
    double factor;
  };
  std::vector<Case> cases;
  for (const TsType& type : ts_rk_types()) {
    auto method = make_ts_rk({.type = type.name});
    if (method->info().is_adaptive) cases.push_back({std::move(method), 30.0});
  }
  for (const TsType& type : ts_rosw_types()) {
    cases.push_back({make_ts_rosw({.type = type.name}), type.name == "2p" ? 200.0 : 30.0});
  }
  for (const char* type : {"a2", "l2", "2c", "3", "4", "5"})
    cases.push_back({make_ts_arkimex({.type = type}), 200.0});
  cases.push_back({make_ts_theta(), 30.0});
  cases.push_back({make_ts_theta({.endpoint = true}), 30.0});
  cases.push_back({make_ts_alpha2(), 30.0});
  for (const int order : {3, 4, 5, 6}) cases.push_back({make_ts_bdf({.order = order}), 30.0});
  const OrderProblem& problem = order_problem(0.25);
  for (const Case& c : cases) {
    for (const double tol : {1e-4, 1e-6}) {
      const Solution solution = solve(*c.method, problem.ivp, tolerance(tol));
      ASSERT_TRUE(solution.status.ok()) << c.method->info().title << ": " << solution.status.describe();
      EXPECT_EQ(solution.time, problem.ivp.t1);
      EXPECT_LT(error_of(solution, problem.reference), c.factor * tol) << c.method->info().title;
      EXPECT_GT(error_of(solution, problem.reference), 1e-4 * tol) << c.method->info().title;
    }
  }
}

TEST(PetscTs, AgreesWithTheReferenceOfACloth) {
  const Ivp ivp = problems::cloth().ivp;
  const Vector reference = reference_of(ivp);
  Methods list = general_methods();
  list.push_back(make_ts_arkimex({.type = "3", .splitting = true}));
  list.push_back(make_ts_arkimex({.type = "4", .splitting = true}));
  for (const auto& method : list) {
    const bool is_first_order = method->info().order == 1;
    const double tol = is_first_order ? 1e-6 : 1e-5;
    const Solution solution = solve(*method, ivp, tolerance(tol));
    ASSERT_TRUE(solution.status.ok()) << method->info().title << ": " << solution.status.describe();
    EXPECT_LT(error_of(solution, reference), is_first_order ? 0.05 : 2e-3) << method->info().title;
  }
}

/// q̈ = −q up to the time `end`, then what `end` says.
struct Interrupted {
  double end;
  bool throws;
  template <class S>
  void operator()(const S& t, std::span<const S> q, std::span<const S>, std::span<S> f) const {
    f[0] = -q[0];
    if constexpr (std::is_same_v<S, double>) {
      if (t <= end) return;
      if (throws) throw std::runtime_error("the spring broke");
      f[0] = std::numeric_limits<double>::quiet_NaN();
    }
  }
};

Ivp interrupted(bool throws, ForceClass forces) {
  Ivp ivp;
  ivp.system = std::make_shared<FunctorSecondOrderSystem<Interrupted>>(Vector{{1.0}}, forces,
                                                                       Interrupted{0.5, throws});
  ivp.y0 = Vector{{1.0, 0.0}};
  return ivp;
}

TEST(PetscTs, EndsWithAStatusWhereTheForceIsNotFinite) {
  Methods list = general_methods();
  list.push_back(make_ts_basicsymplectic());
  const Ivp ivp = interrupted(false, ForceClass::position);
  for (const auto& method : list) {
    std::vector<StepControl> controls{FixedStep{0.0625}};
    if (method->info().is_adaptive) controls.push_back(tolerance(1e-4));
    for (const StepControl& control : controls) {
      const Solution solution = solve(*method, ivp, control);
      EXPECT_EQ(solution.status.code, StatusCode::non_finite)
          << method->info().title << ": " << solution.status.describe();
      EXPECT_TRUE(solution.state.allFinite());
      EXPECT_LE(solution.time, 0.6);
      EXPECT_GT(solution.time, 0.3) << method->info().title;
    }
  }
}

TEST(PetscTs, LetsAnExceptionOfTheForceThrough) {
  Methods list = general_methods();
  list.push_back(make_ts_basicsymplectic());
  const Ivp ivp = interrupted(true, ForceClass::position);
  for (const auto& method : list) {
    try {
      solve(*method, ivp, FixedStep{0.0625});
      ADD_FAILURE() << method->info().title << " has swallowed an exception";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "the spring broke") << method->info().title;
    }
  }
}

struct Growth {
  double rate;
  template <class S>
  void operator()(const S&, std::span<const S> y, std::span<S> dydt) const {
    dydt[0] = S(rate) * y[0];
  }
};

TEST(PetscTs, ReportsASingularMatrix) {
  Ivp ivp;
  ivp.system = std::make_shared<FunctorSystem<Growth>>(1, Growth{16.0});
  ivp.y0 = Vector{{1.0}};
  for (const char* options : {"", "-pc_factor_mat_solver_type petsc"}) {
    const Solution solution = solve(*make_ts_theta({.theta = 1.0, .petsc = options}), ivp, FixedStep{0.0625});
    EXPECT_TRUE(solution.status.code == StatusCode::matrix_singular ||
                solution.status.code == StatusCode::linear_solver_failed)
        << solution.status.describe();
    EXPECT_THAT(solution.status.message,
                testing::AnyOf(HasSubstr("KLU"), HasSubstr("KSP_DIVERGED_PC_FAILED")));
  }
}

struct Explosion {
  template <class S>
  void operator()(const S&, std::span<const S> y, std::span<S> dydt) const {
    dydt[0] = y[0] * y[0];
  }
};

TEST(PetscTs, SaysThatAStepIsTooSmallOrTheStateTooLarge) {
  Ivp ivp;
  ivp.system = std::make_shared<FunctorSystem<Explosion>>(1, Explosion{});
  ivp.y0 = Vector{{1.0}};  // infinite at t = 1
  ivp.t1 = 2.0;
  for (const auto& method : {make_ts_rk(), make_ts_bdf(), make_ts_rosw(), make_ts_arkimex()}) {
    AdaptiveStep control = tolerance(1e-6);
    control.maximum_steps = 200'000;
    const Solution solution = solve(*method, ivp, control);
    EXPECT_FALSE(solution.status.ok()) << method->info().title;
    EXPECT_NEAR(solution.time, 1.0, 1e-2) << method->info().title << ": " << solution.status.describe();
  }
}

TEST(PetscTs, PassesOptionsToEveryPart) {
  const OrderProblem& problem = order_problem(0.25);
  const auto work = [&](const std::string& options) {
    const Solution solution = solve(*make_ts_arkimex({.petsc = options}), problem.ivp, tolerance(1e-5));
    EXPECT_TRUE(solution.status.ok()) << options << ": " << solution.status.describe();
    return solution.work;
  };
  const Work plain = work("");
  EXPECT_NE(work("-ts_adapt_type dsp").accepted_steps, plain.accepted_steps);
  EXPECT_GT(work("-ts_rtol 1e-9 -ts_atol 1e-9").accepted_steps, 2 * plain.accepted_steps);
  EXPECT_LT(work("-snes_rtol 1e-3 -snes_stol 0").newton_iterations, plain.newton_iterations);
  EXPECT_EQ(plain.linear_iterations, 0u);
  EXPECT_GT(work("-ksp_type gmres -pc_type jacobi -ksp_rtol 1e-12").linear_iterations,
            plain.newton_iterations);
  EXPECT_LT(work("-snes_lag_jacobian 4").jacobian_evaluations, plain.jacobian_evaluations);
}

TEST(PetscTs, NamesWhatIsWrongWithItsOptions) {
  const Ivp ivp = driven_pair(0.0);
  const auto message = [&](const std::function<std::unique_ptr<Integrator>()>& make) -> std::string {
    try {
      solve(*make(), ivp, FixedStep{ivp.t1 / 8});
    } catch (const InputError& error) {
      return error.what();
    }
    return "no InputError";
  };
  EXPECT_THAT(message([] { return make_ts_rk({.type = "5pd"}); }), HasSubstr("did you mean"));
  EXPECT_THAT(message([] { return make_ts_theta({.theta = 1.5}); }), HasSubstr("1.5"));
  EXPECT_THAT(message([] { return make_ts_bdf({.order = 7}); }), HasSubstr("7"));
  EXPECT_THAT(message([] { return make_ts_rosw({.type = "rodas"}); }), HasSubstr("rodas3"));
  EXPECT_THAT(message([] { return make_ts_arkimex({.type = ""}); }), HasSubstr("expected one of"));
  EXPECT_THAT(message([] { return make_ts_alpha2({.rho_infinity = -0.1}); }), HasSubstr("-0.1"));
  EXPECT_THAT(message([] { return make_ts_basicsymplectic({.order = 5}); }), HasSubstr("5"));
  EXPECT_THAT(message([] { return make_ts_rk({.petsc = "-ts_adpat_type none"}); }),
              HasSubstr("-ts_adpat_type"));
  EXPECT_THAT(message([] { return make_ts_rk({.petsc = "-ts_type bdf"}); }), HasSubstr("-ts_type"));
  for (const char* option :
       {"-ts_dt 0.3", "-ts_max_steps 3", "-ts_max_time 0.1", "-ts_theta_theta 1", "-ts_rk_type 1fe",
        "-ts_error_if_step_fails", "-ksp_error_if_not_converged", "-ts_adapt_type basic"}) {
    const std::string text = option;
    EXPECT_THAT(message([&text] { return make_ts_theta({.petsc = text}); }),
                HasSubstr(text.substr(0, text.find(' '))));
  }
  EXPECT_THAT(message([] { return make_ts_rk({.petsc = "-ts_adapt_type nonsense"}); }),
              HasSubstr("nonsense"));
  EXPECT_THAT(message([] { return make_ts_bdf({.petsc = "-ksp_type gmress"}); }), HasSubstr("gmress"));
  EXPECT_THAT(message([] { return make_ts_bdf({.petsc = "-snes_rtol tight"}); }), HasSubstr("tight"));
  EXPECT_THAT(message([] { return make_ts_bdf({.petsc = "snes"}); }), HasSubstr("expected an option"));
}

TEST(PetscTs, GivesTheSameBitsTwiceAndInTwoThreads) {
  const OrderProblem& problem = order_problem(0.25);
  for (const auto& method : general_methods()) {
    const Vector alone = solve(*method, problem.ivp, tolerance(1e-5)).state;
    EXPECT_EQ(solve(*method, problem.ivp, tolerance(1e-5)).state, alone) << method->info().title;
    Vector first, second;
    std::thread one([&] { first = solve(*method, problem.ivp, tolerance(1e-5)).state; });
    std::thread two([&] { second = solve(*method, problem.ivp, tolerance(1e-5)).state; });
    one.join();
    two.join();
    EXPECT_EQ(first, alone) << method->info().title;
    EXPECT_EQ(second, alone) << method->info().title;
  }
}

/// Looks at the middle of each step.
class MiddleObserver final : public Observer {
 public:
  bool observe(const StepView& view) override {
    if (view.interpolate) {
      Vector middle(view.state.size());
      const double t = 0.5 * (before_ + view.time);
      view.interpolate(t, middle);
      largest_ = std::max(largest_, std::abs(middle[0] - std::cos(t)));
    }
    before_ = view.time;
    return view.time < 0.7 || !stops;
  }
  double largest() const { return largest_; }
  bool stops = false;

 private:
  double before_ = 0.0, largest_ = 0.0;
};

TEST(PetscTs, InterpolatesAndStopsWhereAnObserverWants) {
  Ivp ivp = interrupted(false, ForceClass::position);
  ivp.system = std::make_shared<FunctorSecondOrderSystem<Interrupted>>(Vector{{1.0}}, ForceClass::position,
                                                                       Interrupted{1e9, false});
  for (const auto& method : {make_ts_rk(), make_ts_rosw(), make_ts_bdf()}) {
    MiddleObserver observer;
    EXPECT_TRUE(method->solve(ivp, FixedStep{0.03125}, observer).status.ok());
    EXPECT_LT(observer.largest(), 1e-3);
    MiddleObserver stopper;
    stopper.stops = true;
    EXPECT_EQ(method->solve(ivp, FixedStep{0.03125}, stopper).status.code, StatusCode::stopped_by_observer);
  }
}

}  // namespace
}  // namespace fw::oracles
