#include "formula/vector_function.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"

namespace fw::formula {

namespace {

template <class Scalar>
Vec3<Scalar> as_scalars(const Vec3<double>& a) {
  return {Scalar(a.x), Scalar(a.y), Scalar(a.z)};
}

/// The derivative on the piece that begins at t_k; zero outside of the table.
template <class Scalar>
Vec3<Scalar> slope_of_piece(const TableFunction& table, std::size_t k) {
  return (Scalar(1) / (Scalar(table.t[k + 1]) - Scalar(table.t[k]))) *
         (as_scalars<Scalar>(table.value[k + 1]) - as_scalars<Scalar>(table.value[k]));
}

template <class Scalar>
VectorJet<Scalar> value_of(const LinearFunction& line, const Scalar& t) {
  const Vec3<Scalar> slope = as_scalars<Scalar>(line.slope);
  return {as_scalars<Scalar>(line.offset) + t * slope, slope};
}

template <class Scalar>
VectorJet<Scalar> value_of(const TableFunction& table, const Scalar& t) {
  // Comparisons with a t that is no number end at the last value: whoever made it sees to that.
  const auto after = std::upper_bound(table.t.begin(), table.t.end(), t,
                                      [](const Scalar& time, double entry) { return time < Scalar(entry); });
  if (after == table.t.begin()) return {as_scalars<Scalar>(table.value.front()), {}};
  if (after == table.t.end()) return {as_scalars<Scalar>(table.value.back()), {}};
  const auto k = static_cast<std::size_t>(after - table.t.begin()) - 1;
  const Vec3<Scalar> slope = slope_of_piece<Scalar>(table, k);
  return {as_scalars<Scalar>(table.value[k]) + (t - Scalar(table.t[k])) * slope, slope};
}

template <class Scalar>
VectorJet<Scalar> value_of(const ExpressionFunction& expressions, const Scalar& t) {
  const Jet<Scalar> x = expressions[0](t), y = expressions[1](t), z = expressions[2](t);
  return {{x.value, y.value, z.value}, {x.rate, y.rate, z.rate}};
}

}  // namespace

VectorFunction::VectorFunction(TableFunction function) {
  if (function.t.empty()) throw InputError("t: found no time, expected at least one");
  if (function.t.size() != function.value.size()) {
    throw InputError(fmt::format("value: found {} vectors, expected {}, one per time", function.value.size(),
                                 function.t.size()));
  }
  for (std::size_t k = 0; k < function.t.size(); ++k) {
    const double before = k > 0 ? function.t[k - 1] : -std::numeric_limits<double>::infinity();
    if (!(function.t[k] > before) || !std::isfinite(function.t[k])) {
      throw InputError(
          fmt::format("t[{}]: found {}, expected a finite number > {}", k, function.t[k], before));
    }
  }
  form_ = std::move(function);
  const auto& table = std::get<TableFunction>(form_);
  if (table.t.size() > 1) corners_ = table.t;
}

VectorJet<double> VectorFunction::operator()(double t) const {
  return evaluate(t);
}
VectorJet<Float128> VectorFunction::operator()(const Float128& t) const {
  return evaluate(t);
}

template <class Scalar>
VectorJet<Scalar> VectorFunction::evaluate(const Scalar& t) const {
  return std::visit([&](const auto& form) { return value_of(form, t); }, form_);
}

bool VectorFunction::is_smooth() const {
  const auto* expressions = std::get_if<ExpressionFunction>(&form_);
  return corners_.empty() &&
         (expressions == nullptr || std::ranges::all_of(*expressions, &Expression::is_smooth));
}

Vec3<double> VectorFunction::slope_change(std::size_t k) const {
  const auto& table = std::get<TableFunction>(form_);
  Vec3<double> change{};
  if (k + 1 < table.t.size()) change += slope_of_piece<double>(table, k);
  if (k > 0) change -= slope_of_piece<double>(table, k - 1);
  return change;
}

}  // namespace fw::formula
