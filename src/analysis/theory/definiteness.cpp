#include "analysis/theory/definiteness.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace fw::analysis {

namespace {

/// Eigenvalues below this share of the largest are rounding.
constexpr double rounding = 1e-12;

Vector eigenvalues_of(const Matrix& symmetric) {
  return Eigen::SelfAdjointEigenSolver<Matrix>(symmetric, Eigen::EigenvaluesOnly).eigenvalues();
}

}  // namespace

double smallest_eigenvalue(const Matrix& symmetric) {
  return eigenvalues_of(symmetric)[0];
}

bool is_positive_definite(const Matrix& symmetric) {
  return Eigen::LLT<Matrix>(symmetric).info() == Eigen::Success;
}

double fastest_growth_rate(const Matrix& K, const Matrix& D, const Vector& mass) {
  const Index n = mass.size();
  if (D.isZero(0.0)) {
    const Vector scale = mass.cwiseSqrt().cwiseInverse();
    const Vector squares = eigenvalues_of(scale.asDiagonal() * K * scale.asDiagonal());
    const double largest = squares[n - 1];
    return largest > rounding * squares.cwiseAbs().maxCoeff() ? std::sqrt(largest) : 0.0;
  }
  const Vector inverse = mass.cwiseInverse();
  Matrix companion = Matrix::Zero(2 * n, 2 * n);
  companion.topRightCorner(n, n).setIdentity();
  companion.bottomLeftCorner(n, n) = inverse.asDiagonal() * K;
  companion.bottomRightCorner(n, n) = inverse.asDiagonal() * D;
  const Eigen::VectorXcd values = Eigen::EigenSolver<Matrix>(companion, false).eigenvalues();
  // Rigid motions are a double eigenvalue zero, which rounding splits into a pair of size √ε.
  const double floor = std::sqrt(rounding) * values.cwiseAbs().maxCoeff();
  double rate = 0.0;
  for (const Complex& value : values) {
    if (std::abs(value.imag()) <= floor && value.real() > floor) rate = std::max(rate, value.real());
  }
  return rate;
}

}  // namespace fw::analysis
