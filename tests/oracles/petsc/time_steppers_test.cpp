#include "oracles/petsc/time_steppers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <thread>

#include "analysis/reference/reference_solution.hpp"
#include "core/error.hpp"
#include "integrators/order_measurement.hpp"
#include "ode/functor_system.hpp"
#include "problems/cloth.hpp"
#include "problems/oscillators.hpp"

namespace fw::oracles {
namespace {

using integrators::driven_pair;
using testing::HasSubstr;

using Methods = std::vector<std::unique_ptr<Integrator>>;

/// One of each family that works on every ẏ = f(t, y) of second order.
Methods general_methods() {
  Methods list;
  list.push_back(make_ts_rk());
  list.push_back(make_ts_theta());
  list.push_back(make_ts_theta({.theta = 1.0, .endpoint = true}));
  list.push_back(make_ts_bdf());
  list.push_back(make_ts_arkimex());
  list.push_back(make_ts_rosw());
  list.push_back(make_ts_alpha2());
  return list;
}

Solution solve(const Integrator& method, const Ivp& ivp, const StepControl& control) {
  NullObserver nobody;
  return method.solve(ivp, control, nobody);
}

AdaptiveStep tolerance(double value) {
  return {.relative_tolerance = value, .absolute_tolerance = value};
}

double error_of(const Solution& solution, const Vector& reference) {
  return (solution.state - reference).lpNorm<Eigen::Infinity>();
}

Vector reference_of(const Ivp& ivp) {
  const analysis::ReferenceSolution solution = analysis::certified_reference(ivp, ivp.t1);
  EXPECT_TRUE(solution.status.ok()) << solution.status.describe();
  return solution.states.front().rounded();
}

/// The driven pair on a longer interval, with its reference.
struct OrderProblem {
  explicit OrderProblem(double damping) : ivp(driven_pair(damping)) {
    ivp.t1 = 4.0;
    reference = reference_of(ivp);
  }
  Ivp ivp;
  Vector reference;
};

const OrderProblem& order_problem(double damping) {
  static const OrderProblem undamped(0.0), damped(0.25);
  return damping == 0.0 ? undamped : damped;
}

/// Two-sided: the order of the end state between `steps` and twice as many constant steps.
void expect_order(const Integrator& method, double damping, int steps, double order) {
  const OrderProblem& problem = order_problem(damping);
  double errors[2];
  for (int k = 0; k < 2; ++k) {
    const double h = problem.ivp.t1 / (steps * (k + 1));
    const Solution solution = solve(method, problem.ivp, FixedStep{h});
    ASSERT_TRUE(solution.status.ok()) << method.info().title << ": " << solution.status.describe();
    EXPECT_EQ(solution.time, problem.ivp.t1);
    EXPECT_EQ(solution.work.accepted_steps, static_cast<std::uint64_t>(steps * (k + 1)));
    errors[k] = error_of(solution, problem.reference);
  }
  EXPECT_GT(errors[1], 3e-14) << "rounding";
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), order, order > 6.0 ? 0.4 : 0.25)
      << method.info().title << ": errors " << errors[0] << " and " << errors[1];
}

int steps_for(int order) {
  constexpr int steps[] = {0, 800, 300, 200, 120, 160, 60, 40, 24};
  return steps[order];
}

TEST(PetscTsRk, HasTheOrderOfItsType) {
  for (const TsType& type : ts_rk_types()) {
    const auto method = make_ts_rk({.type = type.name});
    EXPECT_EQ(method->info().order, type.order);
    for (const double damping : {0.0, 0.25})
      expect_order(*method, damping, steps_for(type.order), type.order);
  }
}

TEST(PetscTsTheta, HasOrderTwoInTheMiddleAndOneElsewhere) {
  for (const bool endpoint : {false, true}) {
    for (const double theta : {0.5, 0.75, 1.0}) {
      const int order = theta == 0.5 ? 2 : 1;
      const auto method = make_ts_theta({.theta = theta, .endpoint = endpoint});
      EXPECT_EQ(method->info().order, order);
      expect_order(*method, 0.25, steps_for(order), order);
    }
  }
}

TEST(PetscTsTheta, IsImplicitEulerAndTheTrapezoidalRule) {
  const Problem problem = problems::harmonic_oscillator({{"mass", 2.0}, {"stiffness", 3.0}});
  Ivp ivp = problem.ivp;
  const double h = 0.25;
  ivp.t1 = ivp.t0 + h;
  Matrix J(2, 2);
  J << 0.0, 1.0, -1.5, 0.0;
  const Matrix I = Matrix::Identity(2, 2);
  const Vector euler = (I - h * J).lu().solve(ivp.y0);
  const Vector trapezoidal = (I - h / 2 * J).lu().solve((I + h / 2 * J) * ivp.y0);
  EXPECT_LT(error_of(solve(*make_ts_theta({.theta = 1.0}), ivp, FixedStep{h}), euler), 1e-14);
  EXPECT_LT(error_of(solve(*make_ts_theta({.theta = 0.5, .endpoint = true}), ivp, FixedStep{h}), trapezoidal),
            1e-14);
}

TEST(PetscTsBdf, HasItsOrderUpToTheStart) {
  for (const int order : {1, 2}) {
    const auto method = make_ts_bdf({.order = order});
    EXPECT_EQ(method->info().order, order);
    expect_order(*method, 0.25, steps_for(order), order);
  }
  // The start keeps all others at order two.
  for (const int order : {4, 5, 6}) {
    const auto method = make_ts_bdf({.order = order});
    EXPECT_EQ(method->info().order, 2);
    expect_order(*method, 0.25, steps_for(2), 2);
  }
}

TEST(PetscTsArkimex, HasTheOrderOfItsType) {
  for (const TsType& type : ts_arkimex_types()) {
    const auto method = make_ts_arkimex({.type = type.name});
    expect_order(*method, 0.25, type.order == 5 ? 80 : steps_for(type.order), type.order);
  }
}

TEST(PetscTsRosw, HasTheOrderOfItsTypeThoughForcesDependOnTime) {
  for (const TsType& type : ts_rosw_types()) {
    expect_order(*make_ts_rosw({.type = type.name}), 0.25, 2 * steps_for(type.order), type.order);
  }
}

TEST(PetscTsAlpha2, HasOrderTwoForSpectralRadiusOneAndOneBelow) {
  expect_order(*make_ts_alpha2({.rho_infinity = 1.0}), 0.25, steps_for(2), 2.0);
  EXPECT_EQ(make_ts_alpha2({.rho_infinity = 0.5})->info().order, 1);
  expect_order(*make_ts_alpha2({.rho_infinity = 0.5}), 0.25, 4 * steps_for(1), 1.0);
}

/// v₁ of one generalised-α step on q̈ = −q from (1, 0) with the initial acceleration a₀.
double velocity_after_a_step(double rho, double h, double a0) {
  const double am = (2.0 - rho) / (1.0 + rho), af = 1.0 / (1.0 + rho);
  const double gamma = 0.5 + am - af, beta = 0.25 * (1.0 + am - af) * (1.0 + am - af);
  // α_m a₁ + (1 − α_m) a₀ = −(1 − α_f) − α_f (1 + h² ((½ − β) a₀ + β a₁))
  const double a1 = (-1.0 - (1.0 - am) * a0 - af * h * h * (0.5 - beta) * a0) / (am + af * h * h * beta);
  return h * ((1.0 - gamma) * a0 + gamma * a1);
}

TEST(PetscTsAlpha2, StartsFromTwiceTheAccelerationBelowRadiusOne) {
  const Problem problem = problems::harmonic_oscillator({{"mass", 1.0}, {"stiffness", 1.0}});
  Ivp ivp = problem.ivp;
  ivp.y0 = Vector{{1.0, 0.0}};
  const double h = 0.0078125, rho = 0.25;
  ivp.t1 = ivp.t0 + h;
  const double found = solve(*make_ts_alpha2({.rho_infinity = rho}), ivp, FixedStep{h}).state[1];
  // v₁ is affine in a₀.
  const double at_zero = velocity_after_a_step(rho, h, 0.0);
  const double a0 = (found - at_zero) / (velocity_after_a_step(rho, h, 1.0) - at_zero);
  EXPECT_NEAR(a0, -2.0, 0.05);  // a version of PETSc that is right gives −1
}

TEST(PetscTsBasicSymplectic, HasItsOrder) {
  for (int order = 1; order <= 4; ++order) {
    expect_order(*make_ts_basicsymplectic({.order = order}), 0.0, steps_for(order), order);
  }
}

TEST(PetscTsBasicSymplectic, RefusesForcesThatDependOnVelocity) {
  EXPECT_THROW(solve(*make_ts_basicsymplectic(), driven_pair(0.25), FixedStep{0.01}), InputError);
}

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

TEST(PetscTsArkimex, KeepsItsOrderWithSplitForces) {
  const Ivp ivp = problems::cloth().ivp;
  const Vector reference = reference_of(ivp);
  for (const TsType& type : {TsType{"2e", 2}, TsType{"3", 3}, TsType{"4", 4}, TsType{"5", 5}}) {
    const auto method = make_ts_arkimex({.type = type.name, .splitting = true});
    const int steps = type.order == 2 ? 200 : 80;
    const double coarse = error_of(solve(*method, ivp, FixedStep{ivp.t1 / steps}), reference);
    const double fine = error_of(solve(*method, ivp, FixedStep{ivp.t1 / (2 * steps)}), reference);
    EXPECT_NEAR(std::log2(coarse / fine), type.order, 0.35) << type.name << ": " << coarse << " " << fine;
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
