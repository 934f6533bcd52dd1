#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/extended_precision.hpp"
#include "formula/jet.hpp"

namespace fw::formula {

/// A function of the time t that a person has written: `0.1*sin(2*pi*t)`.
///
///   sum     = product { ("+" | "-") product }
///   product = sign { ("*" | "/") sign }
///   sign    = [ "+" | "-" ] sign | power
///   power   = primary [ "^" sign ]                     (-2^2 = -4, 2^3^2 = 512)
///   primary = number | "t" | "pi" | name "(" sum { "," sum } ")" | "(" sum ")"
///
/// with the functions sqrt exp log sin cos tan sinh cosh tanh abs of one argument and min max of two. Numbers
/// and pi are the doubles next to them in every arithmetic, so that a reference in binary128 solves the same
/// problem as a method in double.
class Expression {
 public:
  /// InputError that says the place in the text (from 1), what was found and what was expected.
  explicit Expression(std::string_view text);

  /// The value and the derivative by t. Allocates nothing. Not finite where the function is not defined.
  Jet<double> operator()(double t) const;
  Jet<Float128> operator()(const Float128& t) const;

  /// Whether no function in it has kinks (abs, min, max). Poles are not looked for.
  bool is_smooth() const { return is_smooth_; }

  /// How deep operands may wait for their operator.
  static constexpr std::size_t deepest = 64;

  enum class Code : std::uint8_t {
    number,
    time,
    add,
    subtract,
    multiply,
    divide,
    power,
    negate,
    sqrt,
    exp,
    log,
    sin,
    cos,
    tan,
    sinh,
    cosh,
    tanh,
    abs,
    min,
    max,
  };
  struct Instruction {
    Code code = Code::number;
    double number = 0.0;
  };

 private:
  template <class Scalar>
  Jet<Scalar> evaluate(const Scalar& t) const;

  std::vector<Instruction> program_;  ///< in reverse Polish notation
  bool is_smooth_ = true;
};

}  // namespace fw::formula
