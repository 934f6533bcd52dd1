#pragma once

#include <klu.h>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>

#include "linalg/linear_solver.hpp"

namespace fw::linalg {

/// One of Eigen's sparse factorisations. A pattern is analysed once; Eigen allocates work space inside each
/// numerical factorisation.
template <class Factorisation>
class EigenDirectSolver final : public LinearSolver {
 public:
  Status factorise(const SparseMatrix& A, Work& work) override;
  Status replace_matrix(const SparseMatrix& A, Work& work) override { return factorise(A, work); }
  LinearSolve solve(ConstVectorRef b, VectorRef x, Work& work) override;
  /// Each factorisation is made from its matrix alone.
  void forget() override {}
  void serialise(StateArchive& archive) override;

 private:
  Factorisation factorisation_;
  Vector residual_;
  bool is_analysed_ = false;
};

/// LLᵀ of a symmetric positive definite matrix, of which the lower triangle is read.
using SparseCholeskySolver =
    EigenDirectSolver<Eigen::SimplicialLLT<SparseMatrix, Eigen::Lower, Eigen::AMDOrdering<int>>>;
/// LDLᵀ of a symmetric matrix, of which the lower triangle is read. It does not pivot: an indefinite matrix
/// can fail or lose digits, which the true residual shows.
using SparseLdltSolver =
    EigenDirectSolver<Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, Eigen::AMDOrdering<int>>>;
/// LU of any regular matrix by supernodes.
using EigenSparseLuSolver = EigenDirectSolver<Eigen::SparseLU<SparseMatrix, Eigen::COLAMDOrdering<int>>>;

/// P A Q = L U by KLU. The ordering is made once for a pattern; later matrices are refactorised with the same
/// pivots while these stay good (reciprocal condition estimate), and pivoted anew otherwise.
class SparseLuSolver final : public LinearSolver {
 public:
  SparseLuSolver();
  ~SparseLuSolver() override;
  SparseLuSolver(const SparseLuSolver&) = delete;
  SparseLuSolver& operator=(const SparseLuSolver&) = delete;

  Status factorise(const SparseMatrix& A, Work& work) override;
  Status replace_matrix(const SparseMatrix& A, Work& work) override { return factorise(A, work); }
  LinearSolve solve(ConstVectorRef b, VectorRef x, Work& work) override;
  void forget() override;
  void serialise(StateArchive& archive) override;

 private:
  klu_common common_;
  klu_symbolic* symbolic_ = nullptr;
  klu_numeric* numeric_ = nullptr;
  Vector pivot_values_;            ///< of the matrix from which the pivots were chosen
  bool keeps_old_pivots_ = false;  ///< the factors are of a later matrix than the pivots
  Vector residual_;
};

}  // namespace fw::linalg
