#pragma once

#include <klu.h>

#include <Eigen/SparseCholesky>

#include "linalg/linear_solver.hpp"

namespace fw::linalg {

/// LLᵀ of a symmetric positive definite matrix, of which the lower triangle is read. The pattern is analysed
/// once; Eigen allocates work space inside each numerical factorisation.
class SparseCholeskySolver final : public LinearSolver {
 public:
  Status factorise(const SparseMatrix& A, Work& work) override;
  LinearSolve solve(ConstVectorRef b, VectorRef x, Work& work) override;

 private:
  Eigen::SimplicialLLT<SparseMatrix, Eigen::Lower, Eigen::AMDOrdering<int>> cholesky_;
  SparseMatrix matrix_;
  Vector residual_;
  bool analysed_ = false;
};

/// P A Q = L U by KLU. The ordering is made once; later matrices are refactorised with the same pivots while
/// these stay good (reciprocal condition estimate), and pivoted anew otherwise.
class SparseLuSolver final : public LinearSolver {
 public:
  SparseLuSolver();
  ~SparseLuSolver() override;
  SparseLuSolver(const SparseLuSolver&) = delete;
  SparseLuSolver& operator=(const SparseLuSolver&) = delete;

  Status factorise(const SparseMatrix& A, Work& work) override;
  LinearSolve solve(ConstVectorRef b, VectorRef x, Work& work) override;

 private:
  klu_common common_;
  klu_symbolic* symbolic_ = nullptr;
  klu_numeric* numeric_ = nullptr;
  SparseMatrix matrix_;
  Vector residual_;
};

}  // namespace fw::linalg
