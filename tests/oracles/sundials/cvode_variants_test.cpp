#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "analysis/reference/reference_solution.hpp"
#include "core/error.hpp"
#include "integrators/network.hpp"
#include "ode/functor_system.hpp"
#include "oracles/sundials/cvode.hpp"
#include "problems/oscillators.hpp"

namespace fw::oracles {
namespace {

using integrators::random_network;

/// f is NaN from t = 0.5 on.
struct BreaksDown {
  template <class S>
  void operator()(const S& t, std::span<const S> y, std::span<S> dydt) const {
    dydt[0] = real_part(t) < 0.5 ? -y[0] : S(std::numeric_limits<double>::quiet_NaN());
  }
};

struct Spiral {
  template <class S>
  void operator()(const S&, std::span<const S> y, std::span<S> dydt) const {
    dydt[0] = -5.0 * y[0] + 200.0 * y[1];
    dydt[1] = -200.0 * y[0] - 5.0 * y[1];
    dydt[2] = -0.1 * y[2];
  }
};

struct Hopeless {
  template <class S>
  void operator()(const S&, std::span<const S>, std::span<S> dydt) const {
    dydt[0] = S(std::numeric_limits<double>::quiet_NaN());
  }
};

struct Throws {
  template <class S>
  void operator()(const S& t, std::span<const S> y, std::span<S> dydt) const {
    if (real_part(t) > 0.25) throw InputError("no table beyond t = 0.25");
    dydt[0] = -y[0];
  }
};

/// Every way to solve the equations of a step, with the name for messages.
struct Variant {
  std::string name;
  std::unique_ptr<Integrator> integrator;
};

std::vector<Variant> variants() {
  std::vector<Variant> list;
  const auto add = [&](const std::string& name, const CvodeOptions& options) {
    list.push_back({"bdf, " + name, make_cvode_bdf(options)});
    CvodeOptions for_adams = options;
    for_adams.stability_limit_detection = false;
    list.push_back({"adams, " + name, make_cvode_adams(for_adams)});
  };
  add("newton, klu", {.iteration = CvodeIteration::newton});
  add("newton, klu, serial vector",
      {.iteration = CvodeIteration::newton, .vector = VectorOperations::serial});
  add("newton, spgmr", {.iteration = CvodeIteration::newton, .linear_solver = CvodeLinearSolver::spgmr});
  add("fixed point", {.iteration = CvodeIteration::fixed_point});
  add("fixed point, serial vector",
      {.iteration = CvodeIteration::fixed_point, .vector = VectorOperations::serial});
  add("stability limit detection", {.stability_limit_detection = true});
  add("low order", {.maximum_order = 3});
  return list;
}

constexpr AdaptiveStep tight_variants{.relative_tolerance = 1e-9, .absolute_tolerance = 1e-11};

TEST(Cvode, AgreesWithTheCertifiedReferenceInEveryVariant) {
  NullObserver observer;
  const Ivp ivp = random_network(35, {}, 1.0);
  const auto certified = analysis::certified_reference(ivp, ivp.t1);
  ASSERT_TRUE(certified.status.ok()) << certified.status.describe();
  const Vector reference = certified.states.at(0).rounded();
  for (const Variant& variant : variants()) {
    const Solution solution = variant.integrator->solve(ivp, tight_variants, observer);
    ASSERT_TRUE(solution.status.ok()) << variant.name << ": " << solution.status.describe();
    const Index n = ivp.y0.size() / 2;
    EXPECT_LT((solution.state - reference).head(n).lpNorm<Eigen::Infinity>(), 1e-7) << variant.name;
    EXPECT_LT((solution.state - reference).tail(n).lpNorm<Eigen::Infinity>(), 1e-6) << variant.name;
  }
}

TEST(Cvode, CountsTheWorkOfEachVariant) {
  NullObserver observer;
  const Ivp ivp = random_network(36, {}, 1.0);
  for (const Variant& variant : variants()) {
    const Work work = variant.integrator->solve(ivp, tight_variants, observer).work;
    const bool krylov = variant.name.find("spgmr") != std::string::npos;
    const bool fixed_point =
        variant.name.find("fixed point") != std::string::npos ||
        (variant.name.starts_with("adams") && variant.name.find("newton") == std::string::npos);
    EXPECT_GT(work.accepted_steps, 10u) << variant.name;
    EXPECT_GT(work.rhs_evaluations, work.accepted_steps) << variant.name;
    EXPECT_EQ(work.newton_iterations > 0, !fixed_point) << variant.name;
    EXPECT_EQ(work.factorisations > 0, !fixed_point && !krylov) << variant.name;
    EXPECT_EQ(work.jacobian_products > 0, krylov) << variant.name;
    EXPECT_EQ(work.linear_iterations > 0, krylov) << variant.name;
    EXPECT_EQ(work.jacobian_evaluations > 0, !fixed_point) << variant.name;
    EXPECT_LT(work.jacobian_evaluations, work.accepted_steps) << variant.name << ": Jacobians are kept";
  }
}

TEST(Cvode, SolvesAStiffNetworkByKrylovIterationsWithFewOfThem) {
  // Springs so stiff that Newton's matrix is far from the identity: GMRES lives on its preconditioner.
  NullObserver observer;
  Ivp ivp = random_network(37, {}, 0.5);
  mechanics::MassSpringModel model = dynamic_cast<const mechanics::MassSpringSystem&>(*ivp.system).model();
  for (double& stiffness : model.springs.stiffness) stiffness *= 1e3;
  for (double& damping : model.springs.damping) damping *= 1e2;
  ivp.system = std::make_shared<const mechanics::MassSpringSystem>(model);
  const Solution direct = make_cvode_bdf()->solve(ivp, tight_variants, observer);
  const Solution krylov =
      make_cvode_bdf({.linear_solver = CvodeLinearSolver::spgmr})->solve(ivp, tight_variants, observer);
  ASSERT_TRUE(direct.status.ok() && krylov.status.ok());
  EXPECT_LT((direct.state - krylov.state).head(ivp.y0.size() / 2).lpNorm<Eigen::Infinity>(), 1e-8);
  EXPECT_LT(krylov.work.linear_iterations, 12 * krylov.work.newton_iterations);
}

TEST(Cvode, RespectsTheMaximumOrder) {
  // Order 1 needs many more steps; with orders up to 12, Adams needs fewer than with orders up to 2.
  NullObserver observer;
  const Problem problem = problems::harmonic_oscillator();
  const AdaptiveStep control{.relative_tolerance = 1e-6, .absolute_tolerance = 1e-8};
  const auto steps = [&](std::unique_ptr<Integrator> integrator) {
    return integrator->solve(problem.ivp, control, observer).work.accepted_steps;
  };
  CvodeOptions options{.tolerance_factor = 1.0};
  const auto bdf = steps(make_cvode_bdf(options)), adams = steps(make_cvode_adams(options));
  options.maximum_order = 1;
  EXPECT_GT(steps(make_cvode_bdf(options)), 10 * bdf);
  EXPECT_GT(steps(make_cvode_adams(options)), 10 * adams);
}

TEST(Cvode, LowersTheOrderWhereStabilityLimitsIt) {
  // ẏ = λ y with λ near the imaginary axis: BDF of orders 4 and 5 is unstable there, detection sees it.
  Ivp ivp;
  ivp.system = std::make_shared<FunctorSystem<Spiral>>(3, Spiral{});
  ivp.y0 = Vector{{1.0, 0.0, 1.0}};
  ivp.t1 = 40.0;
  NullObserver observer;
  const AdaptiveStep control{.relative_tolerance = 1e-5, .absolute_tolerance = 1e-7};
  const auto solve = [&](bool detection) {
    return make_cvode_bdf({.tolerance_factor = 1.0, .stability_limit_detection = detection})
        ->solve(ivp, control, observer);
  };
  const Solution with = solve(true), without = solve(false);
  ASSERT_TRUE(with.status.ok() && without.status.ok());
  EXPECT_NEAR(with.state[2], std::exp(-4.0), 1e-3);
  EXPECT_LT(2 * with.work.accepted_steps, without.work.accepted_steps)
      << with.work.accepted_steps << " and " << without.work.accepted_steps;
}

TEST(Cvode, RefusesOptionsOutOfRange) {
  EXPECT_THROW(make_cvode_bdf({.maximum_order = 6}), InputError);
  EXPECT_THROW(make_cvode_adams({.maximum_order = 13}), InputError);
  EXPECT_NO_THROW(make_cvode_adams({.maximum_order = 12}));
  EXPECT_THROW(make_cvode_bdf({.maximum_order = -1}), InputError);
  EXPECT_THROW(make_cvode_bdf({.krylov_dimension = 0}), InputError);
  EXPECT_THROW(make_cvode_bdf({.tolerance_factor = 0.0}), InputError);
  EXPECT_THROW(make_cvode_adams({.stability_limit_detection = true}), InputError);
}

TEST(Cvode, ReportsNanOfTheFirstRightHandSide) {
  Ivp ivp;
  ivp.system = std::make_shared<FunctorSystem<Hopeless>>(1, Hopeless{});
  ivp.y0 = Vector{{1.0}};
  NullObserver observer;
  for (const Variant& variant : variants()) {
    const Solution solution = variant.integrator->solve(ivp, tight_variants, observer);
    EXPECT_EQ(solution.status.code, StatusCode::non_finite) << variant.name;
    EXPECT_NE(solution.status.message.find("RHSFUNC"), std::string::npos) << solution.status.describe();
    EXPECT_EQ(solution.state, ivp.y0) << variant.name;
  }
}

TEST(Cvode, StopsWhereTheRightHandSideBreaksDownInEveryVariant) {
  Ivp ivp;
  ivp.system = std::make_shared<FunctorSystem<BreaksDown>>(1, BreaksDown{});
  ivp.y0 = Vector{{1.0}};
  NullObserver observer;
  for (const Variant& variant : variants()) {
    const Solution solution = variant.integrator->solve(ivp, tight_variants, observer);
    EXPECT_FALSE(solution.status.ok()) << variant.name;
    EXPECT_NE(solution.status.message.find("CVODE at t = 0."), std::string::npos)
        << variant.name << ": " << solution.status.describe();
    EXPECT_TRUE(solution.state.allFinite()) << variant.name;
    EXPECT_LE(solution.time, 0.5) << variant.name;
    EXPECT_NEAR(solution.state[0], std::exp(-solution.time), 1e-6) << variant.name;
  }
}

TEST(Cvode, HandsOnWhatTheRightHandSideThrows) {
  Ivp ivp;
  ivp.system = std::make_shared<FunctorSystem<Throws>>(1, Throws{});
  ivp.y0 = Vector{{1.0}};
  NullObserver observer;
  for (const Variant& variant : variants()) {
    try {
      variant.integrator->solve(ivp, tight_variants, observer);
      ADD_FAILURE() << variant.name << ": the exception was lost";
    } catch (const InputError& error) {
      EXPECT_STREQ(error.what(), "no table beyond t = 0.25");
    }
  }
}

TEST(Cvode, ReportsAJacobianThatIsNotFinite) {
  class WrongJacobian final : public OdeSystem {
   public:
    Index size() const override { return 2; }
    void rhs(double, ConstVectorRef y, VectorRef dydt) const override { dydt = -y; }
    void rhs(const Float128&, std::span<const Float128>, std::span<Float128>) const override {}
    void rhs(double, std::span<const Complex>, std::span<Complex>) const override {}
    SparseMatrix jacobian_pattern() const override {
      SparseMatrix pattern = Matrix::Ones(2, 2).sparseView();
      pattern.makeCompressed();
      return pattern;
    }
    void jacobian(double, ConstVectorRef, SparseMatrix& J) const override {
      J.coeffs().setConstant(std::numeric_limits<double>::infinity());
    }
    void jacobian_product(double, ConstVectorRef, ConstVectorRef, VectorRef out) const override {
      out.setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  };
  Ivp ivp;
  ivp.system = std::make_shared<WrongJacobian>();
  ivp.y0 = Vector{{1.0, 2.0}};
  NullObserver observer;
  for (const CvodeLinearSolver solver : {CvodeLinearSolver::klu, CvodeLinearSolver::spgmr}) {
    const Solution solution = make_cvode_bdf({.linear_solver = solver})->solve(ivp, tight_variants, observer);
    EXPECT_FALSE(solution.status.ok());
    EXPECT_NE(solution.status.message.find("CVODE at t = 0"), std::string::npos)
        << solution.status.describe();
    EXPECT_EQ(solution.state, ivp.y0);
  }
}

TEST(Cvode, StopsAtItsLimitOfStepsAndForTheObserverInEveryVariant) {
  struct Impatient final : Observer {
    bool observe(const StepView& view) override { return view.index < 3; }
  };
  const Problem problem = problems::harmonic_oscillator();
  for (const Variant& variant : variants()) {
    NullObserver observer;
    AdaptiveStep control = tight_variants;
    control.maximum_steps = 7;
    const Solution limited = variant.integrator->solve(problem.ivp, control, observer);
    EXPECT_EQ(limited.status.code, StatusCode::step_limit) << variant.name;
    EXPECT_EQ(limited.work.accepted_steps, 7u) << variant.name;
    Impatient impatient;
    const Solution stopped = variant.integrator->solve(problem.ivp, tight_variants, impatient);
    EXPECT_EQ(stopped.status.code, StatusCode::stopped_by_observer) << variant.name;
    EXPECT_EQ(stopped.work.accepted_steps, 3u) << variant.name;
  }
}

}  // namespace
}  // namespace fw::oracles
