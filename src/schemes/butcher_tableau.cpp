#include "schemes/butcher_tableau.hpp"

#include <algorithm>
#include <stdexcept>

namespace fw::schemes {

namespace {

constexpr double binary128_rounding = 1e-31;

template <class Visitor>
void visit_coefficients(const ButcherTableau& tableau, Visitor visit) {
  for (const CoefficientRow& row : tableau.A) std::for_each(row.begin(), row.end(), visit);
  std::for_each(tableau.b.begin(), tableau.b.end(), visit);
  std::for_each(tableau.b_embedded.begin(), tableau.b_embedded.end(), visit);
}

}  // namespace

template <class S>
TableauValues<S> values(const ButcherTableau& tableau) {
  const auto fail = [&](const char* what) {
    throw std::logic_error("tableau \"" + tableau.name + "\": " + what);
  };
  const std::size_t s = tableau.b.size();
  if (s == 0 || tableau.A.size() != s) fail("A must have one row per weight");
  if (!tableau.b_embedded.empty() && tableau.b_embedded.size() != s) fail("b̂ must have one entry per stage");
  if (!tableau.dense.empty() && tableau.dense.size() != s) fail("dense must have one row per stage");
  TableauValues<S> result;
  result.stages = static_cast<int>(s);
  result.name = tableau.name;
  result.a.assign(s * s, S(0));
  result.c.assign(s, S(0));
  for (std::size_t i = 0; i < s; ++i) {
    if (tableau.A[i].size() > s) fail("a row of A is longer than the number of stages");
    for (std::size_t j = 0; j < tableau.A[i].size(); ++j) {
      result.a[i * s + j] = as<S>(tableau.A[i][j]);
    }
  }
  // The nodes are summed in binary128 (exactly for rationals), so that the double c_i is the nearest one.
  for (std::size_t i = 0; i < s; ++i) {
    if constexpr (std::is_same_v<S, double>) {
      Float128 sum = 0;
      for (const Coefficient& a : tableau.A[i]) sum += a.value();
      // Decimals of a source may miss the node that they mean, 1 for example, in their last digit.
      const Float128 rounded = round(Float128(sum * 1e15)) / 1e15;
      result.c[i] = static_cast<double>(abs(sum - rounded) < 1e-17 ? rounded : sum);
    } else {
      for (std::size_t j = 0; j < s; ++j) result.c[i] += result.a[i * s + j];
    }
  }
  for (const Coefficient& weight : tableau.b) result.b.push_back(as<S>(weight));
  for (const Coefficient& weight : tableau.b_embedded) result.b_embedded.push_back(as<S>(weight));
  for (const CoefficientRow& row : tableau.dense) {
    std::vector<S> polynomial;
    for (const Coefficient& coefficient : row) polynomial.push_back(as<S>(coefficient));
    result.dense.push_back(std::move(polynomial));
  }
  return result;
}

template TableauValues<double> values<double>(const ButcherTableau&);
template TableauValues<Float128> values<Float128>(const ButcherTableau&);
template TableauValues<Rational> values<Rational>(const ButcherTableau&);

double uncertainty(const ButcherTableau& tableau) {
  double largest = binary128_rounding;
  visit_coefficients(tableau, [&](const Coefficient& coefficient) {
    largest = std::max(largest, coefficient.uncertainty());
  });
  return largest;
}

bool is_rational(const ButcherTableau& tableau) {
  bool rational = true;
  visit_coefficients(tableau, [&](const Coefficient& coefficient) {
    rational = rational && coefficient.rational().has_value();
  });
  return rational;
}

TableauShape shape(const ButcherTableau& tableau) {
  TableauShape result = TableauShape::explicit_stages;
  for (std::size_t i = 0; i < tableau.A.size(); ++i) {
    for (std::size_t j = i; j < tableau.A[i].size(); ++j) {
      if (tableau.A[i][j].value() == 0) continue;
      if (j > i) return TableauShape::fully_implicit;
      result = TableauShape::diagonal_implicit;
    }
  }
  return result;
}

void check_tableau(const ButcherTableau& tableau) {
  const TableauValues<Float128> numbers = values<Float128>(tableau);
  const Float128 allowed = 100.0 * uncertainty(tableau);
  const auto check_sum = [&](const std::vector<Float128>& weights, const char* name) {
    Float128 sum = 0;
    for (const Float128& weight : weights) sum += weight;
    if (abs(sum - 1) > allowed) {
      throw std::logic_error("tableau \"" + tableau.name + "\": the weights " + name + " must sum to 1");
    }
  };
  check_sum(numbers.b, "b");
  if (!numbers.b_embedded.empty()) check_sum(numbers.b_embedded, "b̂");
}

}  // namespace fw::schemes
