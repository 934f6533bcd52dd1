#include "analysis/theory/growth_matrices.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/special_values.hpp"
#include "dense/eigenvalues.hpp"
#include "dense/factorisations.hpp"

namespace fw::analysis {

namespace {

/// By which a matrix or polynomial may miss the unit circle and still counts as touching it.
constexpr double touching = 1e-12;

/// x_{n+1} = P x_n + Q x_{n−1} on (x_n, x_{n−1}).
Matrix companion(const Matrix& P, const Matrix& Q) {
  const Index n = P.rows();
  Matrix m(2 * n, 2 * n);
  m << P, Q, Matrix::Identity(n, n), Matrix::Zero(n, n);
  return m;
}

/// Coefficients from the constant one on.
using Cubic = std::array<double, 4>;
using Linear = std::array<double, 2>;

/// Adds factor·x·y·z to a polynomial.
void add_product(Cubic& sum, double factor, const Linear& x, const Linear& y, const Linear& z) {
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < 2; ++j) {
      for (std::size_t k = 0; k < 2; ++k) sum[i + j + k] += factor * x[i] * y[j] * z[k];
    }
  }
}

}  // namespace

double spectral_radius(const Eigen::Matrix2d& m) {
  const double trace = m.trace(), determinant = m.determinant();
  if (!std::isfinite(trace) || !std::isfinite(determinant)) return infinity;
  const double discriminant = 0.25 * trace * trace - determinant;
  const double radius =
      discriminant <= 0.0 ? std::sqrt(determinant) : std::abs(0.5 * trace) + std::sqrt(discriminant);
  const bool is_stable = std::abs(trace) <= 1.0 + determinant + touching && determinant <= 1.0 + touching;
  return is_stable ? std::min(radius, 1.0) : radius;
}

double spectral_radius(const Matrix& m) {
  if (!m.allFinite()) return infinity;
  return dense::eigenvalues(m).cwiseAbs().maxCoeff();
}

Matrix verlet_recurrence(LinearRule rule, const Matrix& a, const Matrix& b) {
  const Index n = a.rows();
  const Matrix one = Matrix::Identity(n, n);
  if (rule == LinearRule::verlet_backward_velocity) return companion(2.0 * one - a - b, b - one);
  const Eigen::PartialPivLU<Matrix> implicit((one + 0.5 * b).eval());
  return companion(implicit.solve(2.0 * one - a), implicit.solve(0.5 * b - one));
}

Matrix alpha_step_matrix(const integrators::AlphaParameters& p, const Matrix& a, const Matrix& b) {
  const Index n = a.rows();
  const Matrix one = Matrix::Identity(n, n), zero = Matrix::Zero(n, n);
  Matrix left(3 * n, 3 * n), right(3 * n, 3 * n);
  left << one, zero, -p.beta * one, zero, one, -p.gamma * one, (1.0 - p.alpha_f) * a, (1.0 - p.alpha_f) * b,
      (1.0 - p.alpha_m) * one;
  right << one, one, (0.5 - p.beta) * one, zero, one, (1.0 - p.gamma) * one, -p.alpha_f * a, -p.alpha_f * b,
      -p.alpha_m * one;
  return left.partialPivLu().solve(right);
}

double alpha_growth(const integrators::AlphaParameters& p, double a, double b) {
  const Linear A = {p.alpha_f, 1.0 - p.alpha_f}, M = {p.alpha_m, 1.0 - p.alpha_m};
  const Linear B = {0.5 - p.beta, p.beta}, G = {1.0 - p.gamma, p.gamma};
  const Linear change = {-1.0, 1.0}, one = {1.0, 0.0};
  Cubic c{};
  add_product(c, 1.0, change, change, M);
  add_product(c, b, change, A, G);
  add_product(c, a, one, A, G);
  add_product(c, a, change, A, B);
  if (!std::isfinite(c[0] + c[1] + c[2] + c[3]) || c[3] == 0.0) return infinity;
  for (std::size_t k = 0; k < 3; ++k) c[k] /= c[3];
  Eigen::Matrix3d companion_of;
  companion_of << -c[2], -c[1], -c[0], 1.0, 0.0, 0.0, 0.0, 1.0, 0.0;
  const double radius =
      Eigen::EigenSolver<Eigen::Matrix3d>(companion_of, false).eigenvalues().cwiseAbs().maxCoeff();
  const bool is_stable = 1.0 + c[2] + c[1] + c[0] >= -touching && 1.0 - c[2] + c[1] - c[0] >= -touching &&
                         std::abs(c[0]) <= 1.0 + touching &&
                         1.0 - c[0] * c[0] >= std::abs(c[1] - c[0] * c[2]) - touching;
  return is_stable ? std::min(radius, 1.0) : radius;
}

NystromStages::NystromStages(const schemes::NystromValues<Float128>& t)
    : count_(t.stages),
      a_position_(Matrix::Zero(count_, count_)),
      a_velocity_(Matrix::Zero(count_, count_)),
      c_(count_),
      b_position_(count_),
      b_velocity_(count_),
      has_velocity_(!t.a_velocity.empty()) {
  for (Index i = 0; i < count_; ++i) {
    const auto k = static_cast<std::size_t>(i);
    c_[i] = static_cast<double>(t.c[k]);
    b_position_[i] = static_cast<double>(t.b_position[k]);
    b_velocity_[i] = static_cast<double>(t.b_velocity[k]);
    for (Index j = 0; j < count_; ++j) {
      const auto entry = static_cast<std::size_t>(i * count_ + j);
      a_position_(i, j) = static_cast<double>(t.a_position[entry]);
      if (has_velocity_) a_velocity_(i, j) = static_cast<double>(t.a_velocity[entry]);
    }
  }
  is_diagonal_ = a_position_.triangularView<Eigen::StrictlyUpper>().toDenseMatrix().isZero(0.0) &&
                 a_velocity_.triangularView<Eigen::StrictlyUpper>().toDenseMatrix().isZero(0.0);
}

Eigen::Matrix2d NystromStages::of_vibration(double a, double b) const {
  const Matrix system = Matrix::Identity(count_, count_) + a * a_position_ + b * a_velocity_;
  Matrix right(count_, 2);
  right.col(0).setConstant(-a);
  right.col(1) = -a * c_ - Vector::Constant(count_, b);
  const Matrix k = dense::Lu(system).solve_all(right);
  Eigen::Matrix2d m;
  m << 1.0, 1.0, 0.0, 1.0;
  m.row(0) += b_position_.transpose() * k;
  m.row(1) += b_velocity_.transpose() * k;
  return m;
}

Matrix NystromStages::of_system(const Matrix& W, const Matrix& C, double h) const {
  const Index n = W.rows();
  const Matrix a = h * h * W, b = h * C;
  Matrix position = Matrix::Zero(n, 2 * n), velocity = Matrix::Zero(n, 2 * n);
  position.leftCols(n).setIdentity();
  velocity.rightCols(n).setIdentity();
  std::vector<Matrix> k(static_cast<std::size_t>(count_), Matrix::Zero(n, 2 * n));
  if (is_diagonal_) {
    for (Index i = 0; i < count_; ++i) {
      Matrix x = position + c_[i] * velocity, v = velocity;
      for (Index j = 0; j < i; ++j) {
        if (a_position_(i, j) != 0.0) x += a_position_(i, j) * k[static_cast<std::size_t>(j)];
        if (a_velocity_(i, j) != 0.0) v += a_velocity_(i, j) * k[static_cast<std::size_t>(j)];
      }
      Matrix right = -a * x - b * v;
      if (a_position_(i, i) != 0.0 || a_velocity_(i, i) != 0.0) {
        const Matrix system = Matrix::Identity(n, n) + a_position_(i, i) * a + a_velocity_(i, i) * b;
        right = dense::Lu(system).solve_all(right);
      }
      k[static_cast<std::size_t>(i)] = right;
    }
  } else {
    Matrix system = Matrix::Identity(count_ * n, count_ * n), right(count_ * n, 2 * n);
    for (Index i = 0; i < count_; ++i) {
      right.middleRows(i * n, n) = -a * (position + c_[i] * velocity) - b * velocity;
      for (Index j = 0; j < count_; ++j)
        system.block(i * n, j * n, n, n) += a_position_(i, j) * a + a_velocity_(i, j) * b;
    }
    const Matrix all = dense::Lu(system).solve_all(right);
    for (Index i = 0; i < count_; ++i) k[static_cast<std::size_t>(i)] = all.middleRows(i * n, n);
  }
  Matrix m(2 * n, 2 * n);
  m << position + velocity, velocity;
  for (Index i = 0; i < count_; ++i) {
    m.topRows(n) += b_position_[i] * k[static_cast<std::size_t>(i)];
    m.bottomRows(n) += b_velocity_[i] * k[static_cast<std::size_t>(i)];
  }
  return m;
}

}  // namespace fw::analysis
