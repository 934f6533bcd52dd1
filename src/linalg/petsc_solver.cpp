#include "linalg/petsc_solver.hpp"

namespace fw::linalg {

Status PetscSolver::factorise(const SparseMatrix&, Work&) {
  return {StatusCode::library_failure, "not yet"};
}
Status PetscSolver::replace_matrix(const SparseMatrix&, Work&) {
  return {StatusCode::library_failure, "not yet"};
}
LinearSolve PetscSolver::solve(ConstVectorRef, VectorRef, Work&) {
  return {};
}

}  // namespace fw::linalg
