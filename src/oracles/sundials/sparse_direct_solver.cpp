#include "oracles/sundials/sparse_direct_solver.hpp"

#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_sparse.h>

#include <algorithm>

#include "sparse/sparse_slots.hpp"

namespace fw::oracles::detail {

SparseDirectSolver::SparseDirectSolver(const SparseMatrix& pattern, N_Vector like, SUNContext context)
    : matrix_(own<MatrixPointer>(
          SUNSparseMatrix(pattern.rows(), pattern.cols(), pattern.nonZeros(), CSC_MAT, context),
          "SUNSparseMatrix")),
      solver_(own<LinearSolverPointer>(SUNLinSol_KLU(like, matrix_.get(), context), "SUNLinSol_KLU")),
      last_(pattern) {}

void SparseDirectSolver::copy(const SparseMatrix& source, SUNMatrix target) {
  if (!sparse::same_pattern(last_, source)) {
    last_ = source;
    ++analyses_;
    require(SUNLinSol_KLUReInit(solver_.get(), target, source.nonZeros(), SUNKLU_REINIT_FULL),
            "SUNLinSol_KLUReInit");
  }
  if (SUNSparseMatrix_NNZ(target) < source.nonZeros()) {
    require(SUNSparseMatrix_Reallocate(target, source.nonZeros()), "SUNSparseMatrix_Reallocate");
  }
  std::copy_n(source.outerIndexPtr(), source.cols() + 1, SUNSparseMatrix_IndexPointers(target));
  std::copy_n(source.innerIndexPtr(), source.nonZeros(), SUNSparseMatrix_IndexValues(target));
  std::copy_n(source.valuePtr(), source.nonZeros(), SUNSparseMatrix_Data(target));
}

void SparseDirectSolver::forget() {
  require(SUNLinSol_KLUReInit(solver_.get(), matrix_.get(), SUNSparseMatrix_NNZ(matrix_.get()),
                              SUNKLU_REINIT_PARTIAL),
          "SUNLinSol_KLUReInit");
}

}  // namespace fw::oracles::detail
