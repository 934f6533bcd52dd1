#include "integrators/exponential/krylov_phi.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dense/factorisations.hpp"

namespace fw::integrators {

namespace {

/// φ₁(H) e₁ and φ₂(H) e₁ as columns of exp [[H, e₁, 0], [0, 0, 1], [0, 0, 0]] [Sidje 1998].
Matrix phi_columns(const Matrix& H) {
  const Index m = H.rows();
  Matrix extended = Matrix::Zero(m + 2, m + 2);
  extended.topLeftCorner(m, m) = H;
  extended(0, m) = 1.0;
  extended(m, m + 1) = 1.0;
  const Matrix exponential = dense::exponential(extended);
  return exponential.topRightCorner(m, 2);
}

}  // namespace

KrylovPhi::KrylovPhi(Index size, int largest_dimension)
    : largest_dimension_(static_cast<int>(std::min<Index>(size, largest_dimension))),
      basis_(size, largest_dimension_ + 1),
      hessenberg_(Matrix::Zero(largest_dimension_ + 1, largest_dimension_)),
      next_(size) {}

Status KrylovPhi::multiply(const Apply& apply, ConstVectorRef b, double tolerance, VectorRef out,
                           int& dimension) {
  dimension = 0;
  const double norm = b.norm();
  if (!std::isfinite(norm)) return {StatusCode::non_finite, "the vector of a phi function is not finite"};
  if (norm == 0.0) {
    out.setZero();
    return {};
  }
  basis_.col(0) = b / norm;
  hessenberg_.setZero();
  double estimate = norm;
  int next_test = 4;
  for (int m = 1; m <= largest_dimension_; ++m) {
    apply(basis_.col(m - 1), next_);
    const double length = next_.norm();
    if (!std::isfinite(length)) return {StatusCode::non_finite, "a product with the Jacobian is not finite"};
    for (int pass = 0; pass < 2; ++pass) {  // the second pass keeps the basis orthogonal to rounding
      for (int i = 0; i < m; ++i) {
        const double projection = basis_.col(i).dot(next_);
        hessenberg_(i, m - 1) += projection;
        next_ -= projection * basis_.col(i);
      }
    }
    const double remainder = next_.norm();
    dimension = m;
    // The space is invariant (or the whole space): the result is exact.
    const bool complete = remainder <= 1e-14 * length || m == basis_.rows();
    if (!complete) {
      hessenberg_(m, m - 1) = remainder;
      basis_.col(m) = next_ / remainder;
    }
    if (!complete && m != next_test && m != largest_dimension_) continue;
    next_test = m + std::max(2, m / 4);
    const Matrix phi = phi_columns(hessenberg_.topLeftCorner(m, m));
    // Ritz values lie in the field of values: that of a matrix that is not normal, such as [0, I; −W, −C],
    // reaches far into the right half-plane, where exp overflows. Ritz values of a larger space do not.
    if (!phi.allFinite()) {
      if (!complete && m < largest_dimension_) continue;
      return {
          StatusCode::non_finite,
          fmt::format("a phi function of the Jacobian is not finite in a Krylov space of dimension {}", m)};
    }
    estimate = complete ? 0.0 : norm * remainder * std::abs(phi(m - 1, 1));
    if (estimate <= tolerance) {
      out.noalias() = basis_.leftCols(m) * (norm * phi.col(0));
      return {};
    }
  }
  return {
      StatusCode::linear_solver_failed,
      fmt::format(
          "a Krylov space of dimension {} leaves an error of {:.3g} in a phi function, expected {:.3g}; a "
          "smaller step or a larger krylov_dimension helps",
          largest_dimension_, estimate, tolerance)};
}

}  // namespace fw::integrators
