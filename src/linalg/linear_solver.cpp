#include "linalg/linear_solver.hpp"

#include "linalg/direct_solvers.hpp"
#include "linalg/krylov_solvers.hpp"

namespace fw::linalg {

std::unique_ptr<LinearSolver> make_linear_solver(const LinearSolverOptions& options) {
  switch (options.kind) {
    case LinearSolverKind::conjugate_gradient:
      return std::make_unique<ConjugateGradientSolver>(options);
    case LinearSolverKind::sparse_cholesky:
      return std::make_unique<SparseCholeskySolver>();
    case LinearSolverKind::sparse_lu:
      return std::make_unique<SparseLuSolver>();
  }
  return nullptr;
}

}  // namespace fw::linalg
