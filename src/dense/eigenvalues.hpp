#pragma once

#include "core/types.hpp"

namespace fw::dense {

/// All n eigenvalues of a real n×n matrix in no particular order (Hessenberg form and QR iterations of
/// Eigen); where the iteration does not converge they are what Eigen left. `A` is finite.
Eigen::VectorXcd eigenvalues(const Matrix& A);
/// The same of a complex matrix.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXcd& A);

/// The n eigenvalues, in ascending order, of a symmetric matrix of which the lower triangle is read.
Vector symmetric_eigenvalues(const Matrix& A);

/// A = V diag(λ) Vᵀ of a symmetric matrix, λ in ascending order, V orthogonal with the eigenvectors as
/// columns.
struct SymmetricEigen {
  Vector values;   ///< λ, n
  Matrix vectors;  ///< V, n×n
};
SymmetricEigen symmetric_eigen(const Matrix& A);

}  // namespace fw::dense
