#pragma once

#include <cholmod.h>

#include "linalg/linear_solver.hpp"

namespace fw::linalg {

/// Supernodal LLᵀ of a symmetric positive definite matrix by CHOLMOD on dense kernels of the BLAS
/// [Chen, Davis, Hager, Rajamanickam 2008]; the lower triangle is read. The ordering is made once for a
/// pattern.
class CholmodSolver final : public LinearSolver {
 public:
  CholmodSolver();
  ~CholmodSolver() override;
  CholmodSolver(const CholmodSolver&) = delete;
  CholmodSolver& operator=(const CholmodSolver&) = delete;

  Status factorise(const SparseMatrix& A, Work& work) override;
  Status replace_matrix(const SparseMatrix& A, Work& work) override { return factorise(A, work); }
  LinearSolve solve(ConstVectorRef b, VectorRef x, Work& work) override;
  /// Each factorisation is made from its matrix alone.
  void forget() override {}
  void serialise(StateArchive& archive) override;

 private:
  cholmod_sparse view();  ///< of `matrix_`, without a copy

  cholmod_common common_;
  cholmod_factor* factor_ = nullptr;
  cholmod_dense *solution_ = nullptr, *work_y_ = nullptr, *work_e_ = nullptr;
  Vector residual_;
};

}  // namespace fw::linalg
