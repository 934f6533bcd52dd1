#include "dense/eigenvalues.hpp"

#include <Eigen/Eigenvalues>

namespace fw::dense {

Eigen::VectorXcd eigenvalues(const Matrix& A) {
  return Eigen::EigenSolver<Matrix>(A, false).eigenvalues();
}

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXcd& A) {
  return Eigen::ComplexEigenSolver<Eigen::MatrixXcd>(A, false).eigenvalues();
}

Vector symmetric_eigenvalues(const Matrix& A) {
  return Eigen::SelfAdjointEigenSolver<Matrix>(A, Eigen::EigenvaluesOnly).eigenvalues();
}

SymmetricEigen symmetric_eigen(const Matrix& A) {
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace fw::dense
