#pragma once

#include <memory>

#include "core/types.hpp"

namespace fw::dense {

/// P A = L U of a regular n×n matrix with partial pivoting, for several right-hand sides.
class Lu {
 public:
  explicit Lu(const Matrix& A);
  ~Lu();

  /// A⁻¹ b; `b` has n entries.
  Vector solve(const Vector& b) const;
  /// A⁻¹ B; `B` has n rows.
  Matrix solve_all(const Matrix& B) const;

 private:
  struct Factors;
  std::unique_ptr<const Factors> factors_;
};

/// A⁻¹ b of a symmetric n×n matrix by LDLᵀ with pivoting.
Vector solve_ldlt(const Matrix& A, const Vector& b);

/// Whether LLᵀ of the symmetric matrix, of which the lower triangle is read, exists.
bool is_positive_definite(const Matrix& A);

/// e^A by scaling and squaring [Higham 2005].
Matrix exponential(const Matrix& A);

}  // namespace fw::dense
