#include "oracles/petsc/time_steppers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <thread>

#include "analysis/order_fit.hpp"
#include "analysis/reference_solution.hpp"
#include "core/error.hpp"
#include "integrators/order_measurement.hpp"
#include "ode/functor_system.hpp"
#include "problems/cloth.hpp"
#include "problems/oscillators.hpp"

namespace fw::oracles {
namespace {

using integrators::driven_pair;

/// The order of the end state's error with constant steps, in double.
analysis::OrderFit measured_order(const Integrator& integrator, const Ivp& ivp, const Vector& reference,
                                  int coarsest) {
  std::vector<double> steps, errors;
  for (const double refinement : {1.0, 1.5, 2.0, 3.0, 4.0, 6.0}) {
    const double h = (ivp.t1 - ivp.t0) / std::round(refinement * coarsest);
    NullObserver nobody;
    const Solution solution = integrator.solve(ivp, FixedStep{h}, nobody);
    EXPECT_TRUE(solution.status.ok()) << integrator.info().title << ": " << solution.status.describe();
    EXPECT_EQ(solution.time, ivp.t1);
    steps.push_back(h);
    errors.push_back((solution.state - reference).lpNorm<Eigen::Infinity>());
  }
  for (double e : errors) std::printf(" %.2e", e);
  return analysis::fit_order(steps, errors, 1e-13);
}

Vector reference_of(const Ivp& ivp) {
  const analysis::ReferenceSolution solution = analysis::certified_reference(ivp, ivp.t1);
  EXPECT_TRUE(solution.status.ok()) << solution.status.describe();
  return solution.states.front().rounded();
}

TEST(PetscSurvey, All) {
  for (const double damping : {0.0, 0.25}) {
    const Ivp ivp = driven_pair(damping);
    const Vector reference = reference_of(ivp);
    std::vector<std::unique_ptr<Integrator>> list;
    for (const TsType& type : ts_rk_types()) list.push_back(make_ts_rk({.type = type.name}));
    for (double theta : {0.5, 0.75, 1.0})
      for (bool end : {false, true}) list.push_back(make_ts_theta({.theta = theta, .endpoint = end}));
    for (int order = 1; order <= 6; ++order) list.push_back(make_ts_bdf({.order = order}));
    for (const TsType& type : ts_arkimex_types()) list.push_back(make_ts_arkimex({.type = type.name}));
    for (const TsType& type : ts_rosw_types()) list.push_back(make_ts_rosw({.type = type.name}));
    for (double rho : {0.0, 0.8, 1.0}) list.push_back(make_ts_alpha2({.rho_infinity = rho}));
    if (damping == 0.0)
      for (int order = 1; order <= 4; ++order) list.push_back(make_ts_basicsymplectic({.order = order}));
    for (const auto& method : list) {
      try {
        const auto fit = measured_order(*method, ivp, reference,
                                        method->info().order >= 5   ? 10
                                        : method->info().order >= 3 ? 20
                                                                    : 60);
        std::printf(" | %s: order %.3f (claimed %d) %s\n", method->info().title.c_str(), fit.order,
                    method->info().order, fit.valid ? "" : fit.reason.c_str());
        if (!method->info().is_adaptive) continue;
        for (double tol : {1e-4, 1e-7}) {
          NullObserver nobody;
          const Solution s =
              method->solve(ivp, AdaptiveStep{.relative_tolerance = tol, .absolute_tolerance = tol}, nobody);
          std::printf("   tol %.0e: %s error %.2e steps %d rej %d rhs %d jac %d newton %d\n", tol,
                      s.status.describe().c_str(), (s.state - reference).lpNorm<Eigen::Infinity>(),
                      (int)s.work.accepted_steps, (int)s.work.rejected_steps, (int)s.work.rhs_evaluations,
                      (int)s.work.jacobian_evaluations, (int)s.work.newton_iterations);
        }
      } catch (const std::exception& e) {
        std::printf("%s: %s\n", method->info().title.c_str(), e.what());
      }
    }
  }
}

}  // namespace
}  // namespace fw::oracles
