#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "analysis/fit/order_fit.hpp"
#include "integrators/tableau/explicit_runge_kutta.hpp"
#include "ode/functor_system.hpp"
#include "schemes/explicit_tableaus.hpp"

namespace fw::integrators {

/// Two coupled nonlinear oscillators with masses 1.7 and 0.6, a force that depends on time, and (or not) a
/// damper whose force depends on the positions as well: nothing in it is linear, autonomous, symmetric or
/// one.
struct CoupledForce {
  double damping = 0.0;
  template <class S>
  void operator()(const S& t, std::span<const S> q, std::span<const S> v, std::span<S> f) const {
    using std::cos;
    using std::sin;
    const S d = q[1] - q[0];
    const S pull = S(2) * d + S(0.5) * d * d * d;
    const S damper = S(damping) * (S(1) + q[0] * q[0]) * (v[1] - v[0]);
    f[0] = pull + damper - S(3) * sin(q[0]) + S(0.4) * cos(S(1.3) * t);
    f[1] = -pull - damper - q[1] + S(0.2) * q[1] * sin(t);
  }
};

inline const Vector coupled_mass = Vector{{1.7, 0.6}};

/// The same as a first-order system, for the stage solver without reduction.
struct CoupledSlope {
  CoupledForce force;
  template <class S>
  void operator()(const S& t, std::span<const S> y, std::span<S> dydt) const {
    dydt[0] = y[2];
    dydt[1] = y[3];
    force(t, y.first(2), y.last(2), dydt.last(2));
    dydt[2] /= S(coupled_mass[0]);
    dydt[3] /= S(coupled_mass[1]);
  }
};

inline Ivp coupled_oscillators(double damping) {
  Ivp ivp;
  ivp.system = std::make_shared<FunctorSecondOrderSystem<CoupledForce>>(
      coupled_mass, damping > 0.0 ? ForceClass::velocity : ForceClass::position, CoupledForce{damping});
  ivp.y0 = Vector{{0.8, -0.5, 0.3, 1.1}};
  ivp.t0 = 0.2;
  ivp.t1 = 2.5;
  return ivp;
}

inline Ivp coupled_first_order(double damping) {
  Ivp ivp = coupled_oscillators(damping);
  ivp.system = std::make_shared<FunctorSystem<CoupledSlope>>(4, CoupledSlope{{damping}});
  return ivp;
}

/// Two coupled linear oscillators and their energy, a quadratic invariant.
struct LinearForce {
  template <class S>
  void operator()(const S&, std::span<const S> q, std::span<const S>, std::span<S> f) const {
    f[0] = S(-5) * q[0] + S(2) * q[1];
    f[1] = S(2) * q[0] - S(3) * q[1];
  }
};

inline Ivp linear_oscillators() {
  Ivp ivp = coupled_oscillators(0.0);
  ivp.system = std::make_shared<FunctorSecondOrderSystem<LinearForce>>(coupled_mass, ForceClass::position,
                                                                       LinearForce{});
  ivp.t0 = 0.0;
  ivp.t1 = 100.0;
  return ivp;
}

inline double linear_energy(const Vector& y) {
  return 0.5 * (coupled_mass[0] * y[2] * y[2] + coupled_mass[1] * y[3] * y[3] + 5.0 * y[0] * y[0] +
                3.0 * y[1] * y[1]) -
         2.0 * y[0] * y[1];
}

/// y(t₁) in binary128 by an explicit method of order 5 with its own error below 1e-17.
inline std::vector<Float128> reference_end(const Ivp& ivp) {
  for (const schemes::ButcherTableau& tableau : schemes::explicit_tableaus()) {
    if (tableau.name == "dormand_prince_54") {
      return make_explicit_runge_kutta(tableau)->extended_solver()(ivp, 6000);
    }
  }
  throw std::logic_error("no dormand_prince_54");
}

inline Vector in_double(const std::vector<Float128>& y) {
  Vector result(static_cast<Index>(y.size()));
  for (std::size_t i = 0; i < y.size(); ++i) result[static_cast<Index>(i)] = static_cast<double>(y[i]);
  return result;
}

/// The order observed with constant steps in double.
inline analysis::OrderFit observed_order(const Integrator& scheme, const Ivp& ivp, const Vector& exact,
                                         int first, double ratio = 1.5, int levels = 9,
                                         double floor = 2e-13) {
  std::vector<double> steps, errors;
  double count = first;
  for (int level = 0; level < levels; ++level, count *= ratio) {
    const double h = (ivp.t1 - ivp.t0) / std::round(count);
    NullObserver observer;
    const Solution solution = scheme.solve(ivp, FixedStep{.step = h}, observer);
    EXPECT_TRUE(solution.status.ok()) << scheme.info().name << ": " << solution.status.describe();
    steps.push_back(h);
    errors.push_back((solution.state - exact).lpNorm<Eigen::Infinity>());
  }
  return analysis::fit_order(steps, errors, floor);
}

inline void expect_order(const Integrator& scheme, const Ivp& ivp, const Vector& exact, double expected,
                         int first) {
  const analysis::OrderFit fit = observed_order(scheme, ivp, exact, first);
  EXPECT_TRUE(fit.valid) << scheme.info().name << ": " << fit.reason;
  EXPECT_NEAR(fit.order, expected, 0.1) << scheme.info().name << " from " << fit.points << " points";
  EXPECT_GE(fit.correlation, 0.999) << scheme.info().name;
}

/// ẏ = λ (y − g(t)) + ġ(t), g = sin t + cos 2t [Prothero, Robinson 1974].
struct ProtheroRobinson {
  double rate;
  template <class S>
  void operator()(const S& t, std::span<const S> y, std::span<S> dydt) const {
    using std::cos;
    using std::sin;
    dydt[0] = S(rate) * (y[0] - sin(t) - cos(S(2) * t)) + cos(t) - S(2) * sin(S(2) * t);
  }
};

inline Ivp prothero_robinson(double rate) {
  Ivp ivp;
  ivp.system = std::make_shared<FunctorSystem<ProtheroRobinson>>(1, ProtheroRobinson{rate});
  ivp.y0 = Vector{{1.0}};
  ivp.t1 = 1.9;
  return ivp;
}

inline double prothero_robinson_end() {
  return std::sin(1.9) + std::cos(3.8);
}

}  // namespace fw::integrators
