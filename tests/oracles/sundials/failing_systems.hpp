#pragma once

#include <limits>
#include <memory>
#include <stdexcept>
#include <type_traits>

#include "ode/functor_system.hpp"
#include "ode/ivp.hpp"

namespace fw::oracles {

/// ẏ = −y up to t = ½, then no number.
struct BecomesNaN {
  template <class S>
  void operator()(const S& t, std::span<const S> y, std::span<S> dydt) const {
    dydt[0] = real_part(t) < 0.5 ? -y[0] : S(std::numeric_limits<double>::quiet_NaN());
  }
};

/// ẏ = −y up to t = ½, then an exception.
struct Throws {
  template <class S>
  void operator()(const S& t, std::span<const S> y, std::span<S> dydt) const {
    if (real_part(t) >= 0.5) throw std::runtime_error("the right-hand side gives up");
    dydt[0] = -y[0];
  }
};

/// ẏ = −100 y with a Jacobian (from the complex evaluation) of the wrong sign: Newton's iteration diverges
/// unless steps are small.
struct MisledNewton {
  template <class S>
  void operator()(const S&, std::span<const S> y, std::span<S> dydt) const {
    dydt[0] = S(std::is_same_v<S, Complex> ? 100.0 : -100.0) * y[0];
  }
};

/// ẏ = 8 y: the matrix 1 − 8 h of the implicit Euler method is zero for h = 1/8.
struct GrowsByEight {
  template <class S>
  void operator()(const S&, std::span<const S> y, std::span<S> dydt) const {
    dydt[0] = S(8.0) * y[0];
  }
};

/// ẏ = y² blows up at t = 1 for y(0) = 1.
struct BlowsUp {
  template <class S>
  void operator()(const S&, std::span<const S> y, std::span<S> dydt) const {
    dydt[0] = y[0] * y[0];
  }
};

template <class Functor>
Ivp scalar_problem(Functor functor, double end_time = 2.0) {
  Ivp ivp;
  ivp.system = std::make_shared<FunctorSystem<Functor>>(1, functor);
  ivp.t1 = end_time;
  ivp.y0 = Vector{{1.0}};
  return ivp;
}

}  // namespace fw::oracles
