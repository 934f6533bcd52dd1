#include "schemes/multistep_properties.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "core/types.hpp"
#include "dense/eigenvalues.hpp"

namespace fw::schemes {

namespace {

using Roots = Eigen::VectorXcd;

void check(const MultistepFormula& formula) {
  if (formula.steps() < 1 || formula.alpha.size() != formula.beta.size() ||
      as<Rational>(formula.alpha.back()) != 1) {
    throw std::logic_error("multistep formula \"" + formula.name +
                           "\": expected k + 1 ≥ 2 coefficients α and as many β, "
                           "with α_k = 1");
  }
}

/// C_q = Σ (j^q α_j − q j^{q−1} β_j)/q!.
Rational defect(const MultistepFormula& formula, int q) {
  Rational sum = 0;
  Rational factorial = 1;
  for (int i = 2; i <= q; ++i) factorial *= i;
  for (int j = 0; j <= formula.steps(); ++j) {
    Rational power = 1;  // j^{q−1}, with 0⁰ = 1
    for (int i = 1; i < q; ++i) power *= j;
    const auto index = static_cast<std::size_t>(j);
    const Rational alpha = as<Rational>(formula.alpha[index]);
    if (q == 0) {
      sum += alpha;
    } else {
      sum += power * (j * alpha - q * as<Rational>(formula.beta[index]));
    }
  }
  return sum / factorial;
}

/// Roots of Σ c_j ζ^j as the eigenvalues of its companion matrix; leading zeros lower the degree.
Roots roots(std::vector<Complex> coefficients) {
  while (!coefficients.empty() && coefficients.back() == Complex(0.0)) coefficients.pop_back();
  if (coefficients.size() < 2) return {};
  const auto degree = static_cast<Index>(coefficients.size()) - 1;
  Eigen::MatrixXcd companion = Eigen::MatrixXcd::Zero(degree, degree);
  for (Index i = 0; i + 1 < degree; ++i) companion(i + 1, i) = 1.0;
  for (Index i = 0; i < degree; ++i) {
    companion(i, degree - 1) = -coefficients[static_cast<std::size_t>(i)] / coefficients.back();
  }
  return dense::eigenvalues(companion);
}

std::vector<Complex> polynomial(const CoefficientRow& row) {
  std::vector<Complex> values;
  for (const Coefficient& coefficient : row) values.emplace_back(as<double>(coefficient));
  return values;
}

Complex evaluate(const std::vector<Complex>& coefficients, Complex z) {
  Complex sum = 0.0;
  for (auto c = coefficients.rbegin(); c != coefficients.rend(); ++c) sum = sum * z + *c;
  return sum;
}

/// Coefficients of ρ − μσ by rising powers.
std::vector<Complex> characteristic_polynomial(const MultistepFormula& formula, Complex mu) {
  check(formula);
  std::vector<Complex> difference = polynomial(formula.alpha);
  const std::vector<Complex> sigma = polynomial(formula.beta);
  for (std::size_t j = 0; j < difference.size(); ++j) difference[j] -= mu * sigma[j];
  return difference;
}

bool root_condition(const Roots& values) {
  constexpr double circle = 1e-6;
  constexpr double apart = 1e-4;
  for (Index i = 0; i < values.size(); ++i) {
    const double modulus = std::abs(values[i]);
    if (modulus > 1.0 + circle) return false;
    if (modulus < 1.0 - circle) continue;
    for (Index j = 0; j < values.size(); ++j) {
      if (j != i && std::abs(values[i] - values[j]) < apart) return false;
    }
  }
  return true;
}

}  // namespace

int order_of_accuracy(const MultistepFormula& formula) {
  check(formula);
  int q = 0;
  while (defect(formula, q) == 0) ++q;
  return q - 1;
}

Rational error_constant(const MultistepFormula& formula) {
  const Rational leading = defect(formula, order_of_accuracy(formula) + 1);
  Rational sigma = 0;
  for (const Coefficient& beta : formula.beta) sigma += as<Rational>(beta);
  if (sigma == 0) throw std::logic_error("multistep formula \"" + formula.name + "\": σ(1) = 0");
  return leading / sigma;
}

bool is_zero_stable(const MultistepFormula& formula) {
  check(formula);
  return root_condition(roots(polynomial(formula.alpha)));
}

std::vector<Complex> characteristic_roots(const MultistepFormula& formula, Complex mu) {
  const Roots values = roots(characteristic_polynomial(formula, mu));
  return {values.data(), values.data() + values.size()};
}

double amplification(const MultistepFormula& formula, double real, double imaginary) {
  const std::vector<Complex> difference = characteristic_polynomial(formula, {real, imaginary});
  if (difference.back() == Complex(0.0)) return std::numeric_limits<double>::infinity();
  return roots(difference).cwiseAbs().maxCoeff();
}

double stability_angle(const MultistepFormula& formula) {
  check(formula);
  const std::vector<Complex> rho = polynomial(formula.alpha);
  const std::vector<Complex> sigma = polynomial(formula.beta);
  // At infinity the roots are those of σ, and one more at infinity for each degree that σ lacks.
  if (sigma.back() == Complex(0.0) || !is_zero_stable(formula) || !root_condition(roots(sigma)) ||
      amplification(formula, -1.0, 0.0) >= 1.0) {
    return 0.0;
  }
  // The sector is stable as long as the locus, on which a root has modulus 1, stays out of it.
  constexpr double quarter = 0.5 * std::numbers::pi;
  constexpr double rounding = 1e-12;
  const auto angle = [&](double theta) {
    const Complex z = std::polar(1.0, theta);
    const Complex r = evaluate(rho, z);
    const Complex s = evaluate(sigma, z);
    if (std::abs(s) < rounding) return quarter;
    const Complex mu = r / s;
    if (mu.real() >= -rounding * (1.0 + std::abs(mu))) return quarter;
    return std::abs(std::arg(-mu));
  };
  constexpr int samples = 20'000;
  const double spacing = std::numbers::pi / samples;
  int nearest = 1;
  for (int i = 2; i < samples; ++i) {
    if (angle(i * spacing) < angle(nearest * spacing)) nearest = i;
  }
  double low = (nearest - 1) * spacing, high = (nearest + 1) * spacing;
  for (int i = 0; i < 100; ++i) {
    const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
    (angle(a) < angle(b) ? high : low) = angle(a) < angle(b) ? b : a;
  }
  return std::min(angle(nearest * spacing), angle(0.5 * (low + high))) * 180.0 / std::numbers::pi;
}

bool is_a_stable(const MultistepFormula& formula) {
  return stability_angle(formula) >= 90.0;
}

bool is_l_stable(const MultistepFormula& formula) {
  if (!is_a_stable(formula)) return false;
  return std::all_of(formula.beta.begin(), formula.beta.end() - 1,
                     [](const Coefficient& beta) { return as<Rational>(beta) == 0; });
}

bool is_symmetric(const MultistepFormula& formula) {
  const std::size_t k = formula.alpha.size() - 1;
  for (std::size_t j = 0; j <= k; ++j) {
    if (formula.alpha[j].value() != -formula.alpha[k - j].value()) return false;
    if (formula.beta[j].value() != formula.beta[k - j].value()) return false;
  }
  return true;
}

}  // namespace fw::schemes
