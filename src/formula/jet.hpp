#pragma once

#include <cmath>

#include "core/extended_precision.hpp"

namespace fw::formula {

/// A number that depends on t, and its derivative: (u, du/dt). The rules of differentiation are those of
/// forward accumulation [Griewank, Walther 2008, 3.1]; a derivative that is zero stays zero whatever it is
/// multiplied by, so that constants under a root or a logarithm do no harm.
template <class Scalar>
struct Jet {
  Scalar value{};
  Scalar rate{};  ///< d/dt

  friend Jet operator+(const Jet& a, const Jet& b) { return {a.value + b.value, a.rate + b.rate}; }
  friend Jet operator-(const Jet& a, const Jet& b) { return {a.value - b.value, a.rate - b.rate}; }
  friend Jet operator-(const Jet& a) { return {-a.value, -a.rate}; }
  friend Jet operator*(const Jet& a, const Jet& b) {
    return {a.value * b.value, times(b.value, a.rate) + times(a.value, b.rate)};
  }
  friend Jet operator/(const Jet& a, const Jet& b) {
    const Scalar quotient = a.value / b.value;
    return {quotient, times(1 / b.value, a.rate) - times(quotient / b.value, b.rate)};
  }

  /// factor·rate, and zero for the rate zero.
  static Scalar times(const Scalar& factor, const Scalar& rate) {
    return rate == 0 ? Scalar(0) : Scalar(factor * rate);
  }
};

template <class Scalar>
Jet<Scalar> pow(const Jet<Scalar>& a, const Jet<Scalar>& b) {
  using std::log;
  using std::pow;
  const Scalar value = pow(a.value, b.value);
  const Scalar rate = b.value == 0
                          ? Scalar(0)
                          : Jet<Scalar>::times(Scalar(b.value * pow(a.value, Scalar(b.value - 1))), a.rate);
  return {value, b.rate == 0 ? rate : Scalar(rate + value * log(a.value) * b.rate)};
}

template <class Scalar>
Jet<Scalar> sqrt(const Jet<Scalar>& a) {
  using std::sqrt;
  const Scalar root = sqrt(a.value);
  return {root, Jet<Scalar>::times(Scalar(1 / (2 * root)), a.rate)};
}
template <class Scalar>
Jet<Scalar> exp(const Jet<Scalar>& a) {
  using std::exp;
  const Scalar value = exp(a.value);
  return {value, Jet<Scalar>::times(value, a.rate)};
}
template <class Scalar>
Jet<Scalar> log(const Jet<Scalar>& a) {
  using std::log;
  return {log(a.value), Jet<Scalar>::times(Scalar(1 / a.value), a.rate)};
}
template <class Scalar>
Jet<Scalar> sin(const Jet<Scalar>& a) {
  using std::cos;
  using std::sin;
  return {sin(a.value), Jet<Scalar>::times(cos(a.value), a.rate)};
}
template <class Scalar>
Jet<Scalar> cos(const Jet<Scalar>& a) {
  using std::cos;
  using std::sin;
  return {cos(a.value), Jet<Scalar>::times(-sin(a.value), a.rate)};
}
template <class Scalar>
Jet<Scalar> tan(const Jet<Scalar>& a) {
  using std::tan;
  const Scalar value = tan(a.value);
  return {value, Jet<Scalar>::times(Scalar(1 + value * value), a.rate)};
}
template <class Scalar>
Jet<Scalar> sinh(const Jet<Scalar>& a) {
  using std::cosh;
  using std::sinh;
  return {sinh(a.value), Jet<Scalar>::times(cosh(a.value), a.rate)};
}
template <class Scalar>
Jet<Scalar> cosh(const Jet<Scalar>& a) {
  using std::cosh;
  using std::sinh;
  return {cosh(a.value), Jet<Scalar>::times(sinh(a.value), a.rate)};
}
template <class Scalar>
Jet<Scalar> tanh(const Jet<Scalar>& a) {
  using std::cosh;
  using std::tanh;
  const Scalar c = cosh(a.value);
  return {tanh(a.value), Jet<Scalar>::times(Scalar(1 / (c * c)), a.rate)};
}
/// |a|, with the derivative from the right at a zero of a growing a.
template <class Scalar>
Jet<Scalar> abs(const Jet<Scalar>& a) {
  return a.value < 0 ? -a : a;
}
template <class Scalar>
Jet<Scalar> min(const Jet<Scalar>& a, const Jet<Scalar>& b) {
  return b.value < a.value ? b : a;
}
template <class Scalar>
Jet<Scalar> max(const Jet<Scalar>& a, const Jet<Scalar>& b) {
  return b.value > a.value ? b : a;
}

}  // namespace fw::formula
