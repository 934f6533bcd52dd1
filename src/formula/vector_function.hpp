#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "core/vec3.hpp"
#include "formula/expression.hpp"

namespace fw::formula {

/// A vector that depends on t, and its derivative.
template <class Scalar>
struct VectorJet {
  Vec3<Scalar> value{};
  Vec3<Scalar> rate{};  ///< d/dt
};

/// offset + slope·t.
struct LinearFunction {
  Vec3<double> offset{};
  Vec3<double> slope{};
};

/// Linear between (t_k, value_k), constant before the first and after the last.
struct TableFunction {
  std::vector<double> t;              ///< rising [s]
  std::vector<Vec3<double>> value{};  ///< as many
};

/// One expression per component.
using ExpressionFunction = std::array<Expression, 3>;

/// A vector as a function of t, in one of three forms.
class VectorFunction {
 public:
  /// Zero.
  VectorFunction() = default;
  explicit VectorFunction(LinearFunction function) : form_(function) {}
  /// InputError where the times do not rise, or there are not as many values as times, at least one.
  explicit VectorFunction(TableFunction function);
  explicit VectorFunction(ExpressionFunction function) : form_(std::move(function)) {}

  /// The value and its derivative, at a corner of a table that from the right. Allocates nothing.
  VectorJet<double> operator()(double t) const;
  VectorJet<Float128> operator()(const Float128& t) const;

  /// Whether it has no kinks, as far as that is known.
  bool is_smooth() const;
  /// Where a table's derivative jumps [s], in order; empty for the other forms.
  const std::vector<double>& corners() const { return corners_; }
  /// The jump of the derivative at corner k.
  Vec3<double> slope_change(std::size_t k) const;

 private:
  template <class Scalar>
  VectorJet<Scalar> evaluate(const Scalar& t) const;

  std::variant<LinearFunction, TableFunction, ExpressionFunction> form_;
  std::vector<double> corners_;
};

}  // namespace fw::formula
