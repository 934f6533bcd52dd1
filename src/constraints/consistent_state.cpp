#include "constraints/consistent_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "dense/eigenvalues.hpp"
#include "dense/factorisations.hpp"

namespace fw::constraints {

namespace {

constexpr double smallest_eigenvalue = 1e-12;  ///< relative to the largest
constexpr int most_projections = 50;

Matrix derivative(const DistanceConstraints& constraints, ConstVectorRef q) {
  Matrix G = Matrix::Zero(constraints.size(), constraints.degrees_of_freedom());
  constraints.for_each_derivative(q, [&](Index c, Index i, double slope) { G(c, i) += slope; });
  return G;
}

}  // namespace

Matrix constraint_matrix(const SecondOrderSystem& system, const DistanceConstraints& constraints,
                         ConstVectorRef q) {
  const Matrix G = derivative(constraints, q);
  return G * system.mass().cwiseInverse().asDiagonal() * G.transpose();
}

Status check_independence(const SecondOrderSystem& system, const DistanceConstraints& constraints,
                          ConstVectorRef q) {
  if (constraints.size() == 0) return {};
  Matrix A = constraint_matrix(system, constraints, q);
  // Unit diagonal: light and heavy particles do not count as dependence.
  const Vector scale = A.diagonal().cwiseSqrt().cwiseInverse();
  const auto singular = [&](Index rank) {
    return Status{StatusCode::matrix_singular,
                  fmt::format("of the {} distance constraints {} are independent: G M^-1 G^T is singular",
                              constraints.size(), rank)};
  };
  if (!scale.allFinite()) return singular((A.diagonal().array() > 0.0).count());
  A = scale.asDiagonal() * A * scale.asDiagonal();
  const Vector eigenvalues = dense::symmetric_eigenvalues(A);
  const Index rank = (eigenvalues.array() > smallest_eigenvalue * eigenvalues.maxCoeff()).count();
  return rank == constraints.size() ? Status{} : singular(rank);
}

Vector multipliers(const SecondOrderSystem& system, const DistanceConstraints& constraints, double t,
                   ConstVectorRef q, ConstVectorRef v) {
  Vector acceleration(system.degrees_of_freedom());
  system.force(t, q, v, acceleration);
  acceleration.array() /= system.mass().array();
  Vector right(constraints.size()), curvature(constraints.size());
  constraints.product(q, acceleration, right);
  constraints.product(v, v, curvature);
  return -dense::solve_ldlt(constraint_matrix(system, constraints, q), right + curvature);
}

Status project_on_constraints(const SecondOrderSystem& system, const DistanceConstraints& constraints,
                              VectorRef q, VectorRef v) {
  if (Status status = check_independence(system, constraints, q); !status.ok()) return status;
  const double scale = std::max(q.lpNorm<Eigen::Infinity>(), 1e-300);
  Vector g(constraints.size()), impulse(q.size());
  const auto move = [&](VectorRef target) {
    impulse.setZero();
    constraints.add_transposed_product(q, dense::solve_ldlt(constraint_matrix(system, constraints, q), g),
                                       impulse);
    target -= impulse.cwiseQuotient(system.mass());
  };
  double before = std::numeric_limits<double>::infinity();
  for (int n = 0;; ++n) {
    constraints.value(q, g);
    const double excess = g.lpNorm<Eigen::Infinity>();
    if (excess <= 1e-15 * scale || (excess <= 1e-12 * scale && excess >= before)) break;
    if (n == most_projections || !g.allFinite()) {
      return {
          StatusCode::newton_failed,
          fmt::format("{} projections on the distance constraints left an excess of {:.3g} m", n, excess)};
    }
    before = excess;
    move(q);
  }
  constraints.product(q, v, g);
  move(v);
  return {};
}

}  // namespace fw::constraints
