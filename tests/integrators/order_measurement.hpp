#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "analysis/fit/order_fit.hpp"
#include "analysis/reference/gragg_extrapolation.hpp"
#include "ode/functor_system.hpp"
#include "ode/integrator.hpp"

namespace fw::integrators {

/// Two unlike masses, nonlinear springs, a drive, and where `damping` ≠ 0 dampers whose strength depends on
/// position: nonlinear, non-autonomous, several degrees of freedom, masses other than 1. Every constant is a
/// binary number.
struct DrivenPair {
  double damping = 0.0;

  template <class S>
  void operator()(const S& t, std::span<const S> q, std::span<const S> v, std::span<S> f) const {
    using std::cos;
    const S stretch = q[1] - q[0];
    const S damper = S(damping) * (S(1) + q[0] * q[0]) * (v[1] - v[0]);
    f[0] = S(1.5) * stretch + stretch * stretch - S(2) * q[0] - q[0] * q[0] * q[0] + damper +
           S(0.5) * cos(S(1.75) * t);
    f[1] = -S(1.5) * stretch - stretch * stretch - S(0.5) * q[1] * q[1] * q[1] - damper -
           S(damping) * v[1] * v[1] * v[1];
  }
};

inline Ivp driven_pair(double damping) {
  Ivp ivp;
  ivp.system = std::make_shared<FunctorSecondOrderSystem<DrivenPair>>(
      Vector{{1.5, 0.75}}, damping == 0.0 ? ForceClass::position : ForceClass::velocity, DrivenPair{damping});
  ivp.y0 = Vector{{0.5, -0.25, 0.25, 0.75}};
  ivp.t1 = 1.375;
  return ivp;
}

/// The end state by extrapolation in binary128, good to about 1e-30.
inline std::vector<Float128> extrapolated_end(const Ivp& ivp) {
  const std::vector<double> times{ivp.t1};
  const auto run =
      analysis::integrate_by_extrapolation(ivp, times, {.tableau = analysis::harmonic_extrapolation(14)});
  EXPECT_TRUE(run.status.ok()) << run.status.describe();
  return run.states.front();
}

inline double distance(const std::vector<Float128>& a, const std::vector<Float128>& b) {
  Float128 largest = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const Float128 difference = abs(Float128(a[k] - b[k]));
    if (difference > largest) largest = difference;
  }
  return static_cast<double>(largest);
}

/// The order of the end state's error in binary128, with steps between 1/coarsest and 1/(6·coarsest) of the
/// interval.
inline analysis::OrderFit measured_order(const Integrator& integrator, const Ivp& ivp,
                                         const std::vector<Float128>& reference, std::uint64_t coarsest) {
  std::vector<double> steps, errors;
  for (const double refinement : {1.0, 1.4, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0}) {
    const auto count = static_cast<std::uint64_t>(std::llround(refinement * static_cast<double>(coarsest)));
    steps.push_back((ivp.t1 - ivp.t0) / static_cast<double>(count));
    errors.push_back(distance(integrator.extended_solver()(ivp, count), reference));
  }
  return analysis::fit_order(steps, errors, 1e-28);
}

/// Steps that are fine enough for the asymptotic range and coarse enough for binary128.
inline std::uint64_t coarsest_steps(int order) {
  return order <= 2 ? 400 : order <= 4 ? 150 : order <= 6 ? 80 : 60;
}

/// Two-sided: the order that is claimed is the order that is measured.
inline void expect_order(const Integrator& integrator, const Ivp& ivp, const std::vector<Float128>& reference,
                         int claimed) {
  const analysis::OrderFit fit = measured_order(integrator, ivp, reference, coarsest_steps(claimed));
  ASSERT_TRUE(fit.valid) << integrator.info().name << ": " << fit.reason;
  EXPECT_NEAR(fit.order, claimed, 0.1) << integrator.info().name;
  EXPECT_GT(fit.correlation, 0.999) << integrator.info().name;
}

}  // namespace fw::integrators
