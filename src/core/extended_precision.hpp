#pragma once

#include <boost/multiprecision/float128.hpp>
#include <limits>

#include "core/types.hpp"

namespace fw {

/// IEEE binary128 (113-bit significand, about 34 decimal digits): the arithmetic of reference solutions.
/// Functions such as `sqrt` and `sin` are found by argument-dependent lookup.
using Float128 = boost::multiprecision::float128;

/// 2⁻¹¹², the distance from 1 to the next number.
inline const Float128 float128_epsilon = std::numeric_limits<Float128>::epsilon();

/// The part of a number by which a right-hand side may branch. Differentiation by a complex step perturbs
/// the imaginary part only, so a comparison has to look at the real part.
inline double real_part(double x) {
  return x;
}
inline const Float128& real_part(const Float128& x) {
  return x;
}
inline double real_part(const Complex& x) {
  return x.real();
}

}  // namespace fw
