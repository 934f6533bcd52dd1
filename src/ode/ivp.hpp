#pragma once

#include <memory>
#include <vector>

#include "ode/ode_system.hpp"

namespace fw {

/// An initial value problem ẏ = f(t, y), y(t₀) = y₀ on [t₀, t₁].
struct Ivp {
  std::shared_ptr<const OdeSystem> system;
  double t0 = 0.0;
  double t1 = 1.0;
  Vector y0;
  /// y₀ in binary128 for references. Differs from `y0` where an initial value (such as 1/10) is no double;
  /// empty where `y0` is exact.
  std::vector<Float128> y0_extended;
};

/// y₀ in binary128: `y0_extended`, or the promoted `y0`.
std::vector<Float128> initial_state_extended(const Ivp& ivp);

}  // namespace fw
