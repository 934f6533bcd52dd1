#include "integrators/loop/slope_polynomial.hpp"

#include <cstddef>

namespace fw::integrators {

namespace {

constexpr std::array places_of_slopes{0.0, 0.18, 0.82, 1.0};
constexpr std::size_t count = places_of_slopes.size();

/// Coefficients of θ, θ², …, θ⁵ of an integral from 0.
using Integral = std::array<double, count + 1>;

struct Integrals {
  std::array<Integral, count> lagrange{};  ///< ∫₀^θ l_i
  Integral product{};                      ///< ∫₀^θ ω
};

/// ∫₀^θ scale · ∏_{j ≠ left_out} (τ − θ_j) dτ.
constexpr Integral integral_of_product(std::size_t left_out, double scale) {
  std::array<double, count + 1> product{scale};
  std::size_t degree = 0;
  for (std::size_t j = 0; j < count; ++j) {
    if (j == left_out) continue;
    ++degree;
    for (std::size_t k = degree; k > 0; --k) product[k] = product[k - 1] - places_of_slopes[j] * product[k];
    product[0] *= -places_of_slopes[j];
  }
  Integral integral{};
  for (std::size_t k = 0; k <= degree; ++k) integral[k] = product[k] / static_cast<double>(k + 1);
  return integral;
}

constexpr Integrals integrals_of_all() {
  Integrals all;
  for (std::size_t i = 0; i < count; ++i) {
    double divisor = 1.0;
    for (std::size_t j = 0; j < count; ++j) {
      if (j != i) divisor *= places_of_slopes[i] - places_of_slopes[j];
    }
    all.lagrange[i] = integral_of_product(i, 1.0 / divisor);
  }
  all.product = integral_of_product(count, 1.0);
  return all;
}

constexpr Integrals integrals = integrals_of_all();

constexpr double value(const Integral& integral, double theta) {
  double sum = 0.0;
  for (std::size_t k = integral.size(); k-- > 0;) sum = (sum + integral[k]) * theta;
  return sum;
}

}  // namespace

const std::array<double, 4>& SlopePolynomial::places() {
  return places_of_slopes;
}

SlopePolynomial::Weights SlopePolynomial::weights(double theta) {
  Weights weights{.end = value(integrals.product, theta) / value(integrals.product, 1.0)};
  for (std::size_t i = 0; i < count; ++i) {
    weights.slopes[i] = value(integrals.lagrange[i], theta) - weights.end * value(integrals.lagrange[i], 1.0);
  }
  return weights;
}

}  // namespace fw::integrators
