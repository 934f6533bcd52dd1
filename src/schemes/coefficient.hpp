#pragma once

#include <boost/multiprecision/cpp_int.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/extended_precision.hpp"

namespace fw::schemes {

/// Exact rational numbers, for order conditions without rounding.
using Rational = boost::multiprecision::cpp_rational;

/// A coefficient of a scheme. It is written as in the literature, "-56/15", "(3 - sqrt(3))/6" or, where no
/// closed form is printed, as a decimal with all digits that the source gives, and evaluated in binary128.
///
/// Grammar: sums, differences, products, quotients, parentheses, unary minus, sqrt(…), decimal numbers.
class Coefficient {
 public:
  Coefficient() : Coefficient(0) {}
  Coefficient(int value);
  /// Throws std::logic_error where the text is no such expression.
  Coefficient(const char* text);
  Coefficient(const std::string& text);
  /// A number that a formula has computed in binary128.
  Coefficient(const Float128& value);
  /// An expression that stands for an irrational number near it, such as a quotient of long integers that a
  /// source prints in place of decimals; `uncertainty` bounds |value − what is meant|.
  static Coefficient approximation(const std::string& text, double uncertainty);

  const std::string& text() const { return text_; }
  const Float128& value() const { return value_; }
  /// The same without rounding; empty where a square root or a computed number is in it. A decimal counts as
  /// the rational that it prints only where it has at most 15 digits; a longer one is a rounded number.
  const std::optional<Rational>& rational() const { return rational_; }
  /// A bound of |value − what is meant|: 0 for closed forms, else half a unit of the last digit printed.
  double uncertainty() const { return uncertainty_; }

 private:
  std::string text_;
  Float128 value_;
  std::optional<Rational> rational_;
  double uncertainty_ = 0.0;
};

using CoefficientRow = std::vector<Coefficient>;

/// The coefficient in the arithmetic S: double, Float128 or Rational (which throws std::logic_error where
/// there is no exact value).
template <class S>
S as(const Coefficient& coefficient);

}  // namespace fw::schemes
