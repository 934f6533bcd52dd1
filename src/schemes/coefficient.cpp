#include "schemes/coefficient.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>

namespace fw::schemes {

namespace {

/// A number on its way through the expression: the binary128 value and, as long as there is one, the exact
/// one.
struct Term {
  Float128 value;
  std::optional<Rational> rational;
};

/// Recursive descent over the grammar of `Coefficient`.
class Parser {
 public:
  explicit Parser(const std::string& text) : text_(text) {}

  Term parse() {
    Term result = sum();
    if (position_ != text_.size()) fail("an operator or the end");
    return result;
  }
  double uncertainty() const { return uncertainty_; }

 private:
  Term sum() {
    Term left = product();
    for (char op = peek(); op == '+' || op == '-'; op = peek()) {
      ++position_;
      const Term right = product();
      left.value = op == '+' ? Float128(left.value + right.value) : Float128(left.value - right.value);
      combine(left, right, [op](const Rational& a, const Rational& b) {
        return op == '+' ? Rational(a + b) : Rational(a - b);
      });
    }
    return left;
  }

  Term product() {
    Term left = factor();
    for (char op = peek(); op == '*' || op == '/'; op = peek()) {
      ++position_;
      const Term right = factor();
      if (op == '/' && right.value == 0) fail("a divisor other than 0");
      left.value = op == '*' ? Float128(left.value * right.value) : Float128(left.value / right.value);
      combine(left, right, [op](const Rational& a, const Rational& b) {
        return op == '*' ? Rational(a * b) : Rational(a / b);
      });
    }
    return left;
  }

  Term factor() {
    const char c = peek();
    if (c == '-') {
      ++position_;
      Term inner = factor();
      inner.value = -inner.value;
      if (inner.rational) inner.rational = Rational(-*inner.rational);
      return inner;
    }
    if (c == '(') return parenthesis();
    if (text_.compare(position_, 5, "sqrt(") == 0) {
      position_ += 4;
      const Term inner = parenthesis();
      if (inner.value < 0) fail("a radicand that is not negative");
      return {sqrt(inner.value), std::nullopt};
    }
    return number();
  }

  Term parenthesis() {
    ++position_;
    Term inner = sum();
    if (peek() != ')') fail(")");
    ++position_;
    return inner;
  }

  Term number() {
    std::string digits;
    int decimals = 0;
    bool fraction = false;
    while (position_ < text_.size() &&
           (std::isdigit(static_cast<unsigned char>(text_[position_])) != 0 || text_[position_] == '.')) {
      const char c = text_[position_++];
      if (c == '.') {
        if (fraction) fail("one decimal point");
        fraction = true;
      } else {
        digits += c;
        if (fraction) ++decimals;
      }
    }
    if (digits.empty()) fail("a number");
    int exponent = 0;
    if (position_ < text_.size() && (text_[position_] == 'e' || text_[position_] == 'E')) {
      std::size_t used = 0;
      try {
        exponent = std::stoi(text_.substr(position_ + 1), &used);
      } catch (const std::logic_error&) {
        fail("an exponent");
      }
      position_ += used + 1;
    }
    using Integer = boost::multiprecision::cpp_int;
    const auto first = digits.find_first_not_of('0');
    const std::string significant = first == std::string::npos ? "0" : digits.substr(first);
    const int power = exponent - decimals;
    const Integer scale = boost::multiprecision::pow(Integer(10), static_cast<unsigned>(std::abs(power)));
    const Rational exact =
        power < 0 ? Rational(Integer(significant), scale) : Rational(Integer(significant) * scale);
    const Float128 value = exact.convert_to<Float128>();
    constexpr std::size_t digits_of_a_rounded_number = 16;
    if (fraction && significant.size() >= digits_of_a_rounded_number) {
      uncertainty_ = std::max(uncertainty_, 0.5 * std::pow(10.0, power));
      return {value, std::nullopt};
    }
    return {value, exact};
  }

  template <class Operation>
  static void combine(Term& left, const Term& right, Operation operation) {
    if (left.rational && right.rational) {
      left.rational = operation(*left.rational, *right.rational);
      // One rounding only, instead of one for each operation.
      left.value = left.rational->template convert_to<Float128>();
    } else {
      left.rational.reset();
    }
  }

  char peek() {
    while (position_ < text_.size() && text_[position_] == ' ') ++position_;
    return position_ < text_.size() ? text_[position_] : '\0';
  }

  [[noreturn]] void fail(const std::string& expected) const {
    throw std::logic_error("coefficient \"" + text_ + "\": expected " + expected + " at position " +
                           std::to_string(position_));
  }

  const std::string& text_;
  std::size_t position_ = 0;
  double uncertainty_ = 0.0;
};

}  // namespace

Coefficient::Coefficient(int value)
    : text_(std::to_string(value)), value_(value), rational_(Rational(value)) {}

Coefficient::Coefficient(const char* text) : Coefficient(std::string(text)) {}

Coefficient::Coefficient(const std::string& text) : text_(text) {
  Parser parser(text_);
  Term term = parser.parse();
  value_ = term.value;
  rational_ = std::move(term.rational);
  uncertainty_ = parser.uncertainty();
}

Coefficient::Coefficient(const Float128& value) : text_(value.str(33)), value_(value) {}

Coefficient Coefficient::approximation(const std::string& text, double uncertainty) {
  Coefficient result(text);
  result.rational_.reset();
  result.uncertainty_ = uncertainty;
  return result;
}

template <>
double as<double>(const Coefficient& coefficient) {
  return static_cast<double>(coefficient.value());
}

template <>
Float128 as<Float128>(const Coefficient& coefficient) {
  return coefficient.value();
}

template <>
Rational as<Rational>(const Coefficient& coefficient) {
  if (!coefficient.rational()) {
    throw std::logic_error("coefficient \"" + coefficient.text() + "\" is not an exact rational");
  }
  return *coefficient.rational();
}

}  // namespace fw::schemes
