#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "analysis/reference/reference_solution.hpp"
#include "integrators/order_measurement.hpp"
#include "oracles/petsc/time_steppers.hpp"

namespace fw::oracles {

using integrators::driven_pair;

using Methods = std::vector<std::unique_ptr<Integrator>>;

/// One of each family that works on every ẏ = f(t, y) of second order.
inline Methods general_methods() {
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

inline Solution solve(const Integrator& method, const Ivp& ivp, const StepControl& control) {
  NullObserver nobody;
  return method.solve(ivp, control, nobody);
}

inline AdaptiveStep tolerance(double value) {
  return {.relative_tolerance = value, .absolute_tolerance = value};
}

inline double error_of(const Solution& solution, const Vector& reference) {
  return (solution.state - reference).lpNorm<Eigen::Infinity>();
}

inline Vector reference_of(const Ivp& ivp) {
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

inline const OrderProblem& order_problem(double damping) {
  static const OrderProblem undamped(0.0), damped(0.25);
  return damping == 0.0 ? undamped : damped;
}

}  // namespace fw::oracles
