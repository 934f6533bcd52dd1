#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "analysis/fit/order_fit.hpp"
#include "analysis/reference/reference_solution.hpp"
#include "network.hpp"
#include "ode/functor_system.hpp"

namespace fw::integrators {

/// Three masses on nonlinear springs, driven, with or without linear and cubic dampers: nonlinear,
/// non-autonomous, several degrees of freedom, masses other than 1.
struct DrivenChain {
  double damping = 0.0;

  template <class S>
  void operator()(const S& t, std::span<const S> q, std::span<const S> v, std::span<S> f) const {
    using std::cos;
    using std::sin;
    S previous_position(0), previous_velocity(0);
    for (std::size_t i = 0; i < 3; ++i) f[i] = S(0);
    for (std::size_t i = 0; i < 3; ++i) {
      const S d = q[i] - previous_position;
      const S w = v[i] - previous_velocity;
      const S tension = S(1.25 + 0.5 * static_cast<double>(i)) * d + d * d * d + S(damping) * (w + w * w * w);
      f[i] -= tension;
      if (i > 0) f[i - 1] += tension;
      previous_position = q[i];
      previous_velocity = v[i];
    }
    f[0] += S(2) * cos(S(1.3) * t);
    f[2] += sin(S(0.7) * t) * cos(q[1]);
  }
};

inline Ivp driven_chain(bool damped, double end_time = 1.5) {
  Ivp ivp;
  const Vector mass{{1.7, 0.6, 2.3}};
  ivp.system = std::make_shared<FunctorSecondOrderSystem<DrivenChain>>(
      mass, damped ? ForceClass::velocity : ForceClass::position, DrivenChain{damped ? 0.4 : 0.0});
  ivp.t0 = 0.2;
  ivp.t1 = ivp.t0 + end_time;
  ivp.y0 = Vector{{0.5, -0.25, 0.75, -1.0, 0.5, 0.25}};
  return ivp;
}

/// A nonlinear, non-autonomous first-order system without mechanical structure.
struct FirstOrderFlow {
  template <class S>
  void operator()(const S& t, std::span<const S> y, std::span<S> dydt) const {
    using std::cos;
    using std::sin;
    dydt[0] = -y[0] * y[1] + cos(S(2) * t);
    dydt[1] = y[0] - S(0.5) * y[1] + sin(y[0]) * t;
  }
};

inline Ivp first_order_flow() {
  Ivp ivp;
  ivp.system = std::make_shared<FunctorSystem<FirstOrderFlow>>(2, FirstOrderFlow{});
  ivp.t0 = 0.3;
  ivp.t1 = 1.9;
  ivp.y0 = Vector{{1.0, 0.5}};
  return ivp;
}

inline Vector certified_end(const Ivp& ivp) {
  const analysis::ReferenceSolution reference = analysis::certified_reference(ivp, ivp.t1);
  EXPECT_TRUE(reference.status.ok()) << reference.status.describe();
  return reference.states.back().rounded();
}

struct ObservedOrders {
  analysis::OrderFit position{}, velocity{};
};

/// Fits orders to the end errors of both halves of the state with `coarsest`·`refinement`^k steps, k = 0 …
/// levels − 1.
inline ObservedOrders observed_orders(const Integrator& scheme, const Ivp& ivp, const Vector& reference,
                                      int coarsest, int levels, double refinement) {
  std::vector<double> steps, position, velocity;
  const Index n = ivp.y0.size() / 2;
  for (int k = 0; k < levels; ++k) {
    const double count = std::round(coarsest * std::pow(refinement, k));
    const double h = (ivp.t1 - ivp.t0) / count;
    const Solution solution = run(scheme, ivp, h);
    EXPECT_TRUE(solution.status.ok()) << scheme.info().name << ": " << solution.status.describe();
    const Vector error = solution.state - reference;
    steps.push_back(h);
    position.push_back(error.head(n).norm());
    velocity.push_back(error.tail(n).norm());
  }
  const double floor = 1e-13 * (1.0 + reference.norm());
  return {analysis::fit_order(steps, position, floor), analysis::fit_order(steps, velocity, floor)};
}

/// Both halves of the state converge with the order given, within `window`.
inline void expect_order(const Integrator& scheme, const Ivp& ivp, const Vector& reference, double order,
                         int coarsest, int levels, const std::string& what,
                         double refinement = std::numbers::sqrt2, double window = 0.1) {
  const ObservedOrders observed = observed_orders(scheme, ivp, reference, coarsest, levels, refinement);
  for (const auto& [fit, half] :
       {std::pair{observed.position, "positions"}, std::pair{observed.velocity, "velocities"}}) {
    EXPECT_TRUE(fit.valid) << scheme.info().name << ", " << what << ", " << half << ": " << fit.reason;
    EXPECT_NEAR(fit.order, order, window) << scheme.info().name << ", " << what << ", " << half;
    EXPECT_GE(fit.correlation, 0.999) << scheme.info().name << ", " << what << ", " << half;
  }
}

/// Order on the driven chain without and with dampers, as the scheme claims it.
inline void expect_claimed_orders(const Integrator& scheme, int coarsest, int levels,
                                  double refinement = std::numbers::sqrt2) {
  for (const bool damped : {false, true}) {
    if (damped && scheme.info().needs.has(Capability::position_forces)) continue;
    const Ivp ivp = driven_chain(damped);
    static const std::array<Vector, 2> references = {certified_end(driven_chain(false)),
                                                     certified_end(driven_chain(true))};
    const int order = damped ? scheme.info().order_with_velocity_forces : scheme.info().order;
    expect_order(scheme, ivp, certified_end(ivp), order, coarsest, levels, damped ? "damped" : "undamped",
                 refinement);
  }
}

/// The same on a network of springs.
inline void expect_claimed_orders_of_springs(const Integrator& scheme, int coarsest, int levels,
                                             double refinement = std::numbers::sqrt2) {
  for (const bool damped : {false, true}) {
    const auto network = [](bool with_dampers) {
      return random_network(31, {.is_damped = with_dampers}, 0.31);
    };
    static const std::array<Vector, 2> references = {certified_end(network(false)),
                                                     certified_end(network(true))};
    const Ivp ivp = network(damped);
    const int order = damped ? scheme.info().order_with_velocity_forces : scheme.info().order;
    expect_order(scheme, ivp, certified_end(ivp), order, coarsest, levels, damped ? "damped" : "undamped",
                 refinement);
  }
}

}  // namespace fw::integrators
