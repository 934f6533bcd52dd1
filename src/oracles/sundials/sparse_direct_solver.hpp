#pragma once

#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_sparse.h>

#include <algorithm>

#include "oracles/sundials/sundials_objects.hpp"

namespace fw::oracles::detail {

/// A sparse matrix of SUNDIALS with the pattern of ours, and KLU for it.
struct SparseDirectSolver {
  SparseDirectSolver(const SparseMatrix& pattern, N_Vector like, SUNContext context)
      : matrix(own<MatrixPointer>(
            SUNSparseMatrix(pattern.rows(), pattern.cols(), pattern.nonZeros(), CSC_MAT, context),
            "SUNSparseMatrix")),
        solver(own<LinearSolverPointer>(SUNLinSol_KLU(like, matrix.get(), context), "SUNLinSol_KLU")) {}

  /// Copies pattern and values: SUNDIALS clears a matrix, pattern included, before it asks for its entries.
  static void copy(const SparseMatrix& source, SUNMatrix target) {
    std::copy_n(source.outerIndexPtr(), source.cols() + 1, SUNSparseMatrix_IndexPointers(target));
    std::copy_n(source.innerIndexPtr(), source.nonZeros(), SUNSparseMatrix_IndexValues(target));
    std::copy_n(source.valuePtr(), source.nonZeros(), SUNSparseMatrix_Data(target));
  }

  /// KLU orders and pivots anew at the next factorisation.
  void forget() {
    require(SUNLinSol_KLUReInit(solver.get(), matrix.get(), SUNSparseMatrix_NNZ(matrix.get()),
                                SUNKLU_REINIT_PARTIAL),
            "SUNLinSol_KLUReInit");
  }

  MatrixPointer matrix;
  LinearSolverPointer solver;
};

}  // namespace fw::oracles::detail
