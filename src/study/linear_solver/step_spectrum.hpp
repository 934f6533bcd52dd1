#pragma once

#include "core/types.hpp"

namespace fw::study {

/// All eigenvalues of the symmetric positive definite matrix of an implicit step, in ascending order.
struct StepSpectrum {
  Vector eigenvalues;               ///< of A [kg]
  Vector eigenvalues_block_jacobi;  ///< of L⁻¹ A L⁻ᵀ, L Lᵀ the diagonal blocks of A [1]

  double condition() const { return eigenvalues[eigenvalues.size() - 1] / eigenvalues[0]; }
  double condition_block_jacobi() const {
    return eigenvalues_block_jacobi[eigenvalues.size() - 1] / eigenvalues_block_jacobi[0];
  }

  /// The number of iterations after which conjugate gradients with the block-Jacobi preconditioner have
  /// ‖r‖₂ ≤ tolerance·‖b‖₂ from a zero guess, by ‖e_k‖_A ≤ 2((√κ − 1)/(√κ + 1))^k ‖e_0‖_A with the condition
  /// κ of the preconditioned matrix and ‖r_k‖₂/‖r_0‖₂ ≤ √κ(A) ‖e_k‖_A/‖e_0‖_A [Saad 2003, 6.11].
  double iteration_bound(double tolerance) const;
};

/// The spectrum by dense methods, O(n³). The blocks are 3×3 where the size is a multiple of three, else 1×1.
StepSpectrum spectrum_of(const SparseMatrix& A);

}  // namespace fw::study
