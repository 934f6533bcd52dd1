#pragma once

#include <memory>

#include "linalg/linear_solver.hpp"

namespace fw::linalg {

/// PETSc's KSP [Balay et al. 2022]: conjugate gradients preconditioned by an incomplete Cholesky
/// factorisation unless `petsc_options` say otherwise. One process; matrices AIJ, BAIJ and SBAIJ.
///
/// - Iterations stop at ‖b − A x‖₂ ≤ tolerance·‖b‖₂ (unpreconditioned norm) where the Krylov method can
/// measure it and the options do not choose a norm; otherwise in the norm of the method. In any case the true
/// residual decides afterwards: more than ten times the tolerance has failed, and so has a direct solve
/// (`-ksp_type preonly` with lu, cholesky or qr) above `largest_direct_residual`.
/// - `-ksp_rtol` and `-ksp_max_it` take the places of `relative_tolerance` and `max_iterations`.
/// - SBAIJ takes the upper triangle of a matrix that has to be symmetric.
/// - InputError (from the constructor, or from the first `factorise`, when PETSc reads them): options that
/// PETSc did not use, unknown types, values out of range. A combination that PETSc does not support is a
/// Status.
/// - Failures are PETSc's reasons: KSPConvergedReason and PCFailedReason by name.
class PetscSolver final : public LinearSolver {
 public:
  /// Throws InputError for an option text without form, a tolerance or coordinates that make no sense.
  explicit PetscSolver(LinearSolverOptions options);
  ~PetscSolver() override;

  Status factorise(const SparseMatrix& A, Work& work) override;
  Status replace_matrix(const SparseMatrix& A, Work& work) override;
  LinearSolve solve(ConstVectorRef b, VectorRef x, Work& work) override;
  void forget() override;
  void serialise(StateArchive& archive) override;

 private:
  class Engine;
  LinearSolverOptions options_;
  std::unique_ptr<Engine> engine_;  ///< made for each pattern
  Vector residual_;
};

}  // namespace fw::linalg
