#pragma once

#include <functional>
#include <vector>

#include "core/types.hpp"

namespace fw::integrators {

/// A matrix of s×s blocks that share one sparse pattern with a full diagonal, as in the coupled stages of a
/// fully implicit scheme: block (i, j) = δ_ij·diag(m) + Σ_p w_p(i, j)·P_p. Its pattern is made once; blocks
/// whose weights are all zero are left out.
class StageMatrix {
 public:
  /// `is_present[i·s + j]`: whether block (i, j) may have entries (the diagonal blocks always do).
  StageMatrix(const SparseMatrix& pattern, int stages, const std::vector<char>& is_present);

  /// A part P_p of the blocks with its s×s weights, row by row.
  struct Part {
    const SparseMatrix& matrix;
    const std::vector<double>& weights;
    double factor;
  };

  /// `diagonal`: m, one entry per row of the pattern.
  const SparseMatrix& assemble(ConstVectorRef diagonal, const std::vector<Part>& parts);

 private:
  int stages_;
  std::vector<char> is_present_;
  SparseMatrix matrix_;
  std::vector<Index> diagonal_;  ///< position of each diagonal entry in the value array
};

}  // namespace fw::integrators
