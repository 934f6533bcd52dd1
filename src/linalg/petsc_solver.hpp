#pragma once

#include "linalg/linear_solver.hpp"

namespace fw::linalg {

/// PETSc's KSP.
class PetscSolver final : public LinearSolver {
 public:
  explicit PetscSolver(LinearSolverOptions options) : options_(std::move(options)) {}

  Status factorise(const SparseMatrix& A, Work& work) override;
  Status replace_matrix(const SparseMatrix& A, Work& work) override;
  LinearSolve solve(ConstVectorRef b, VectorRef x, Work& work) override;

 private:
  LinearSolverOptions options_;
};

}  // namespace fw::linalg
