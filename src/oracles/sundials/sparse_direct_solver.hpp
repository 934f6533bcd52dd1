#pragma once

#include "core/types.hpp"
#include "oracles/sundials/sundials_objects.hpp"

namespace fw::oracles::detail {

/// A sparse matrix of SUNDIALS with the pattern of ours, and KLU for it.
class SparseDirectSolver {
 public:
  /// Throws SystemError where SUNDIALS cannot make them.
  SparseDirectSolver(const SparseMatrix& pattern, N_Vector like, SUNContext context);

  /// Copies pattern and values into `target`, the matrix or a copy of it that SUNDIALS made: SUNDIALS clears
  /// a matrix, pattern included, before it asks for its entries. Where the pattern is not that of the last
  /// call, `target` gets room for it and KLU analyses it at its next factorisation, and only then.
  void copy(const SparseMatrix& source, SUNMatrix target);

  /// KLU orders and pivots anew at the next factorisation.
  void forget();

  SUNLinearSolver solver() const { return solver_.get(); }
  SUNMatrix matrix() const { return matrix_.get(); }

  /// How many patterns KLU has had to analyse.
  std::uint64_t analyses() const { return analyses_; }

 private:
  MatrixPointer matrix_;
  LinearSolverPointer solver_;
  SparseMatrix last_;  ///< with the pattern that KLU knows
  std::uint64_t analyses_ = 1;
};

}  // namespace fw::oracles::detail
