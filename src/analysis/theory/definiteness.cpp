#include "analysis/theory/definiteness.hpp"

#include <algorithm>
#include <cmath>

#include "dense/eigenvalues.hpp"
#include "dense/factorisations.hpp"

namespace fw::analysis {

namespace {

/// Eigenvalues below this share of the largest are rounding.
constexpr double rounding = 1e-12;

}  // namespace

double smallest_eigenvalue(const Matrix& symmetric) {
  return dense::symmetric_eigenvalues(symmetric)[0];
}

bool is_positive_definite(const Matrix& symmetric) {
  return dense::is_positive_definite(symmetric);
}

double fastest_growth_rate(const Matrix& K, const Matrix& D, const Vector& mass) {
  const Index n = mass.size();
  if (D.isZero(0.0)) {
    const Vector scale = mass.cwiseSqrt().cwiseInverse();
    const Vector squares = dense::symmetric_eigenvalues(scale.asDiagonal() * K * scale.asDiagonal());
    const double largest = squares[n - 1];
    return largest > rounding * squares.cwiseAbs().maxCoeff() ? std::sqrt(largest) : 0.0;
  }
  const Vector inverse = mass.cwiseInverse();
  Matrix companion = Matrix::Zero(2 * n, 2 * n);
  companion.topRightCorner(n, n).setIdentity();
  companion.bottomLeftCorner(n, n) = inverse.asDiagonal() * K;
  companion.bottomRightCorner(n, n) = inverse.asDiagonal() * D;
  const Eigen::VectorXcd values = dense::eigenvalues(companion);
  // Rigid motions are a double eigenvalue zero, which rounding splits into a pair of size √ε.
  const double floor = std::sqrt(rounding) * values.cwiseAbs().maxCoeff();
  double rate = 0.0;
  for (const Complex& value : values) {
    if (std::abs(value.imag()) <= floor && value.real() > floor) rate = std::max(rate, value.real());
  }
  return rate;
}

}  // namespace fw::analysis
