#pragma once

#include "core/types.hpp"

namespace fw::analysis {

/// λ_min of a symmetric matrix by dense methods, O(n³).
double smallest_eigenvalue(const Matrix& symmetric);

/// Whether a Cholesky factorisation of a symmetric matrix succeeds.
bool is_positive_definite(const Matrix& symmetric);

/// The fastest growth rate μ > 0 [1/s] of M ü = K u + D u̇ with symmetric K and D ≤ 0 and a diagonal M: the
/// largest real eigenvalue of [[0, I], [M⁻¹K, M⁻¹D]]; 0 where none is positive.
///
/// A(h) = M − h D − h² K is positive definite exactly for h < 1/μ: xᵀA(h)x falls through zero once at most,
/// and det A(h) = 0 for h = 1/μ says (μ²M − μD − K)x = 0 (erratum E5).
double fastest_growth_rate(const Matrix& K, const Matrix& D, const Vector& mass);

}  // namespace fw::analysis
