#include "dense/factorisations.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <unsupported/Eigen/MatrixFunctions>

namespace fw::dense {

struct Lu::Factors {
  Eigen::PartialPivLU<Matrix> lu;
};

Lu::Lu(const Matrix& A) : factors_(new Factors{Eigen::PartialPivLU<Matrix>(A)}) {}
Lu::~Lu() = default;

Vector Lu::solve(const Vector& b) const {
  return factors_->lu.solve(b);
}

Matrix Lu::solve_all(const Matrix& B) const {
  return factors_->lu.solve(B);
}

Vector solve_ldlt(const Matrix& A, const Vector& b) {
  return A.ldlt().solve(b);
}

bool is_positive_definite(const Matrix& A) {
  return Eigen::LLT<Matrix>(A).info() == Eigen::Success;
}

Matrix exponential(const Matrix& A) {
  return A.exp();
}

}  // namespace fw::dense
