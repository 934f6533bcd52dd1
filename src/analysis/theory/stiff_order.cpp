#include "analysis/theory/stiff_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "schemes/linear_form.hpp"
#include "schemes/multistep_properties.hpp"

namespace fw::analysis {

namespace {

/// The terms of the local error that are looked at: beyond, h^k/k! makes them irrelevant.
constexpr int most_terms = 12;
/// Where powers of z are read off. In binary128 nothing is lost out there.
constexpr double far_out = -1e5, farther_out = -1e6;
/// Smaller than what the coefficients of the literature (16 digits at least) leave of a zero.
constexpr double negligible = 1e-13;
/// By how much the leading term has to be above all others for one power of h to be seen.
constexpr double dominance = 10.0;

/// What the error of a step depends on.
struct StageData {
  std::size_t stages = 0;
  std::vector<Float128> matrix;  ///< B, row by row
  std::vector<Float128> nodes;   ///< α
  std::vector<Float128> gamma;   ///< γ_i
  std::vector<Float128> weights;

  const Float128& B(std::size_t i, std::size_t j) const { return matrix[i * stages + j]; }
};

StageData stage_data(const schemes::ButcherTableau& tableau) {
  const auto values = schemes::values<Float128>(tableau);
  const auto s = static_cast<std::size_t>(values.stages);
  return {s, values.a, values.c, std::vector<Float128>(s, Float128(0)), values.b};
}

StageData stage_data(const schemes::RosenbrockTableau& tableau) {
  const auto s = static_cast<std::size_t>(tableau.stages());
  StageData data{s,
                 std::vector<Float128>(s * s, Float128(0)),
                 std::vector<Float128>(s, Float128(0)),
                 std::vector<Float128>(s, Float128(0)),
                 {}};
  for (std::size_t i = 0; i < s; ++i) {
    data.weights.push_back(tableau.b[i].value());
    for (std::size_t j = 0; i < tableau.alpha.size() && j < tableau.alpha[i].size(); ++j) {
      data.matrix[i * s + j] += tableau.alpha[i][j].value();
      data.nodes[i] += tableau.alpha[i][j].value();
    }
    for (std::size_t j = 0; j < tableau.gamma[i].size(); ++j) {
      data.matrix[i * s + j] += tableau.gamma[i][j].value();
      data.gamma[i] += tableau.gamma[i][j].value();
    }
  }
  return data;
}

std::optional<StageData> stage_data(const schemes::SchemeData& data) {
  if (const auto* tableau = std::get_if<schemes::ButcherTableau>(&data)) return stage_data(*tableau);
  if (const auto* tableau = std::get_if<schemes::RosenbrockTableau>(&data)) return stage_data(*tableau);
  return std::nullopt;
}

/// x with (I − zB) x = rhs by elimination with row exchanges.
std::vector<Float128> solve(const StageData& data, const Float128& z, std::vector<Float128> rhs) {
  const std::size_t s = data.stages;
  std::vector<Float128> a(s * s);
  for (std::size_t i = 0; i < s; ++i) {
    for (std::size_t j = 0; j < s; ++j)
      a[i * s + j] = (i == j ? Float128(1) : Float128(0)) - z * data.B(i, j);
  }
  for (std::size_t k = 0; k < s; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < s; ++i) {
      if (abs(a[i * s + k]) > abs(a[pivot * s + k])) pivot = i;
    }
    if (pivot != k) {
      for (std::size_t j = 0; j < s; ++j) std::swap(a[k * s + j], a[pivot * s + j]);
      std::swap(rhs[k], rhs[pivot]);
    }
    for (std::size_t i = k + 1; i < s; ++i) {
      const Float128 factor = a[i * s + k] / a[k * s + k];
      for (std::size_t j = k; j < s; ++j) a[i * s + j] -= factor * a[k * s + j];
      rhs[i] -= factor * rhs[k];
    }
  }
  for (std::size_t k = s; k-- > 0;) {
    for (std::size_t j = k + 1; j < s; ++j) rhs[k] -= a[k * s + j] * rhs[j];
    rhs[k] /= a[k * s + k];
  }
  return rhs;
}

/// C_k(z).
double local_coefficient(const StageData& data, int k, double z_value) {
  const Float128 z = z_value;
  std::vector<Float128> rhs(data.stages);
  for (std::size_t i = 0; i < data.stages; ++i) {
    const Float128 power = k == 1 ? Float128(1) : Float128(pow(data.nodes[i], k - 1));
    rhs[i] = Float128(k) * power - z * power * data.nodes[i];
    if (k == 1) rhs[i] -= z * data.gamma[i];
    if (k == 2) rhs[i] += 2 * data.gamma[i];
  }
  const std::vector<Float128> stages = solve(data, z, std::move(rhs));
  Float128 sum = -1;
  for (std::size_t i = 0; i < data.stages; ++i) sum += data.weights[i] * stages[i];
  return static_cast<double>(sum);
}

/// The local error C h^{p+1} φ^{(p+1)} is divided by α_k − zβ_k; where σ has no other root than zero, nothing
/// adds up.
StiffOrder stiff_order(const schemes::MultistepFormula& formula) {
  StiffOrder result;
  for (std::size_t j = 0; j + 1 < formula.beta.size(); ++j) {
    if (formula.beta[j].value() == 0) continue;
    result.reason = "a multistep formula that is no backward differentiation formula";
    return result;
  }
  result.order = schemes::order_of_accuracy(formula);
  result.power_of_step = result.order + 1;
  result.power_of_product = 1;
  result.valid = true;
  return result;
}

/// Of stages with the stability function R.
StiffOrder stiff_order(const StageData& stages, const schemes::StabilityFunction& R, double step,
                       double lambda) {
  StiffOrder result;
  if (R.numerator.size() > R.denominator.size()) {
    result.reason = "the scheme is explicit: |R| grows without bound";
    return result;
  }
  const double at_infinity = R.numerator.size() < R.denominator.size()
                                 ? 0.0
                                 : static_cast<double>(R.numerator.back() / R.denominator.back());
  if (std::abs(at_infinity) > 1.0 + 1e-12) {
    result.reason = fmt::format("|R(infinity)| = {:.4g}: errors grow", std::abs(at_infinity));
    return result;
  }
  double largest = 0.0, second = 0.0, factor = 1.0;
  for (int k = 1; k <= most_terms; ++k) {
    factor *= step / k;
    const double near = std::abs(local_coefficient(stages, k, far_out));
    const double far = std::abs(local_coefficient(stages, k, farther_out));
    if (near < negligible || far < negligible) continue;
    const auto power = static_cast<int>(std::lround(std::log10(near / far)));
    const double size = factor * std::abs(local_coefficient(stages, k, step * lambda));
    if (size <= largest) {
      second = std::max(second, size);
      continue;
    }
    second = largest;
    largest = size;
    result.power_of_step = k;
    result.power_of_product = power;
  }
  if (result.power_of_step == 0) {
    result.reason = "no term of the local error was found";
    return result;
  }
  if (largest < dominance * second) {
    result.reason = "two terms of the local error compete";
    return result;
  }
  result.accumulates = std::abs(at_infinity - 1.0) < 1e-9;
  if (result.accumulates) {
    const double decay = std::abs(1.0 - R(std::complex<double>(far_out)).real());
    result.memory = decay > 0.0 ? 1.0 / (decay * std::abs(far_out)) : std::numeric_limits<double>::infinity();
  }
  result.order = result.power_of_step - result.power_of_product - (result.accumulates ? 1 : 0);
  result.valid = true;
  return result;
}

}  // namespace

std::string StiffOrder::formula() const {
  // (hλ)^{−m} h^k, with one power less where errors add up.
  const int of_step = order;
  const std::string step = of_step == 0 ? "1" : of_step == 1 ? "h" : fmt::format("h^{}", of_step);
  if (power_of_product == 0) return step;
  return power_of_product == 1 ? step + "/lambda" : fmt::format("{}/lambda^{}", step, power_of_product);
}

StiffOrder stiff_order(const schemes::SchemeData& data, double step, double lambda) {
  const schemes::LinearForm form = schemes::linear_form(data);
  if (const auto* formula = std::get_if<schemes::MultistepFormula>(&form)) return stiff_order(*formula);
  const std::optional<StageData> stages = stage_data(data);
  if (stages) return stiff_order(*stages, std::get<schemes::StabilityFunction>(form), step, lambda);
  StiffOrder unknown;
  unknown.reason = "no coefficients of a Runge-Kutta, Rosenbrock or multistep scheme";
  return unknown;
}

}  // namespace fw::analysis
