#include "study/linear_solver/step_spectrum.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "dense/eigenvalues.hpp"

namespace fw::study {

namespace {

/// The Cholesky factors of the 3×3 diagonal blocks (1×1 where the size is no multiple of three), applied from
/// both sides: L⁻¹ A L⁻ᵀ has the spectrum of the block-Jacobi preconditioned matrix.
Matrix block_jacobi_scaled(const Matrix& A) {
  const Index n = A.rows(), block = n % 3 == 0 ? 3 : 1;
  Matrix scaled = A;
  for (Index first = 0; first < n; first += block) {
    const Eigen::LLT<Matrix> cholesky(A.block(first, first, block, block));
    scaled.middleRows(first, block) = cholesky.matrixL().solve(scaled.middleRows(first, block)).eval();
    scaled.middleCols(first, block) =
        cholesky.matrixL().solve(scaled.middleCols(first, block).transpose()).transpose().eval();
  }
  return scaled;
}

}  // namespace

double StepSpectrum::iteration_bound(double tolerance) const {
  const double root = std::sqrt(condition_block_jacobi());
  if (root <= 1.0 + 1e-12) return 1.0;
  return std::ceil(std::log(tolerance / (2.0 * std::sqrt(condition()))) /
                   std::log((root - 1.0) / (root + 1.0)));
}

StepSpectrum spectrum_of(const SparseMatrix& A) {
  const Matrix dense(A);
  return {dense::symmetric_eigenvalues(dense), dense::symmetric_eigenvalues(block_jacobi_scaled(dense))};
}

}  // namespace fw::study
