#include "schemes/nystrom_tableau.hpp"

#include <algorithm>
#include <stdexcept>

namespace fw::schemes {

template <class S>
NystromValues<S> values(const NystromTableau& tableau) {
  const std::size_t s = tableau.c.size();
  const auto fail = [&](const char* what) {
    throw std::logic_error("Nyström tableau \"" + tableau.name + "\": " + what);
  };
  const auto row = [&](const CoefficientRow& coefficients, const char* what) {
    if (coefficients.size() != s) fail(what);
    std::vector<S> result;
    for (const Coefficient& coefficient : coefficients) result.push_back(as<S>(coefficient));
    return result;
  };
  const auto square = [&](const std::vector<CoefficientRow>& rows) {
    if (rows.size() != s) fail("a matrix must have one row per stage");
    std::vector<S> result(s * s, S(0));
    for (std::size_t i = 0; i < s; ++i) {
      if (rows[i].size() > s) fail("a row is longer than the number of stages");
      for (std::size_t j = 0; j < rows[i].size(); ++j) result[i * s + j] = as<S>(rows[i][j]);
    }
    return result;
  };
  if (s == 0) fail("there must be a stage");
  NystromValues<S> result;
  result.stages = static_cast<int>(s);
  result.c = row(tableau.c, "c");
  result.a_position = square(tableau.A_position);
  if (!tableau.A_velocity.empty()) result.a_velocity = square(tableau.A_velocity);
  result.b_position = row(tableau.b_position, "b̄ must have one entry per stage");
  result.b_velocity = row(tableau.b_velocity, "b must have one entry per stage");
  if (!tableau.b_position_embedded.empty()) {
    result.b_position_embedded = row(tableau.b_position_embedded, "embedded b̄ must have one entry per stage");
    result.b_velocity_embedded = row(tableau.b_velocity_embedded, "embedded b must have one entry per stage");
  }
  return result;
}

template NystromValues<double> values<double>(const NystromTableau&);
template NystromValues<Float128> values<Float128>(const NystromTableau&);
template NystromValues<Rational> values<Rational>(const NystromTableau&);

double uncertainty(const NystromTableau& tableau) {
  double largest = 1e-31;
  const auto visit = [&](const CoefficientRow& row) {
    for (const Coefficient& coefficient : row) largest = std::max(largest, coefficient.uncertainty());
  };
  visit(tableau.c);
  for (const CoefficientRow& row : tableau.A_position) visit(row);
  for (const CoefficientRow& row : tableau.A_velocity) visit(row);
  visit(tableau.b_position);
  visit(tableau.b_velocity);
  visit(tableau.b_position_embedded);
  visit(tableau.b_velocity_embedded);
  return largest;
}

template <class S>
NystromValues<S> as_nystrom(const TableauValues<S>& tableau) {
  const auto s = static_cast<std::size_t>(tableau.stages);
  const auto squared_weights = [&](const std::vector<S>& weights) {
    std::vector<S> result(s, S(0));
    for (std::size_t j = 0; j < s; ++j) {
      for (std::size_t i = 0; i < s; ++i) result[j] += weights[i] * tableau.a[i * s + j];
    }
    return result;
  };
  NystromValues<S> result;
  result.stages = tableau.stages;
  result.c = tableau.c;
  result.a_velocity = tableau.a;
  result.a_position.assign(s * s, S(0));
  for (std::size_t i = 0; i < s; ++i) {
    for (std::size_t k = 0; k < s; ++k) {
      for (std::size_t j = 0; j < s; ++j) {
        result.a_position[i * s + j] += tableau.a[i * s + k] * tableau.a[k * s + j];
      }
    }
  }
  result.b_velocity = tableau.b;
  result.b_position = squared_weights(tableau.b);
  if (!tableau.b_embedded.empty()) {
    result.b_velocity_embedded = tableau.b_embedded;
    result.b_position_embedded = squared_weights(tableau.b_embedded);
  }
  return result;
}

template NystromValues<double> as_nystrom<double>(const TableauValues<double>&);
template NystromValues<Float128> as_nystrom<Float128>(const TableauValues<Float128>&);
template NystromValues<Rational> as_nystrom<Rational>(const TableauValues<Rational>&);

}  // namespace fw::schemes
