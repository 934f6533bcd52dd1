#include "linalg/linear_solver.hpp"

#include <fmt/format.h>

#include <sstream>

#include "core/error.hpp"
#include "linalg/cholmod_solver.hpp"
#include "linalg/direct_solvers.hpp"
#include "linalg/krylov_solvers.hpp"
#include "linalg/petsc_solver.hpp"
#include "sparse/sparse_slots.hpp"
#include "text/closest_name.hpp"

namespace fw::linalg {

const std::vector<LinearSolverInfo>& linear_solvers() {
  using Kind = LinearSolverKind;
  static const std::vector<LinearSolverInfo> list = {
      {"cg", "conjugate gradients, 3×3 block Jacobi", Kind::conjugate_gradient, true, true, true},
      {"cholesky", "Eigen LLᵀ", Kind::sparse_cholesky, true, true, false},
      {"ldlt", "Eigen LDLᵀ", Kind::sparse_ldlt, true, false, false},
      {"lu", "KLU", Kind::sparse_lu, false, false, false},
      {"eigen_cg", "Eigen conjugate gradients, diagonal", Kind::eigen_conjugate_gradient, true, true, true},
      {"eigen_lu", "Eigen supernodal LU", Kind::eigen_sparse_lu, false, false, false},
      {"cholmod", "CHOLMOD supernodal LLᵀ", Kind::cholmod, true, true, false},
      {"petsc", "PETSc KSP", Kind::petsc, false, false, true}};
  return list;
}

const LinearSolverInfo& find_linear_solver(const std::string& name) {
  std::vector<std::string> names;
  for (const LinearSolverInfo& info : linear_solvers()) {
    if (info.name == name) return info;
    names.push_back(info.name);
  }
  throw InputError(fmt::format("unknown linear solver \"{}\", expected {}{}", name, linear_solver_names(),
                               did_you_mean(name, names)));
}

const LinearSolverInfo& find_linear_solver(LinearSolverKind kind) {
  for (const LinearSolverInfo& info : linear_solvers()) {
    if (info.kind == kind) return info;
  }
  throw InputError("a linear solver without an entry in the list");
}

std::string linear_solver_names() {
  std::string text;
  const std::vector<LinearSolverInfo>& list = linear_solvers();
  for (std::size_t i = 0; i < list.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == list.size() ? " or " : ", ") + list[i].name;
  }
  return text;
}

LinearSolverOptions read_linear_solver(const std::string& call) {
  std::istringstream words(call);
  std::string name;
  words >> name;
  LinearSolverOptions options{.kind = find_linear_solver(name).kind};
  for (std::string word; words >> word;) {
    if (options.kind != LinearSolverKind::petsc) {
      throw InputError(fmt::format("linear solver \"{}\" takes no options, found \"{}\"", name, word));
    }
    if (word != "-mat_type") {
      options.petsc_options += (options.petsc_options.empty() ? "" : " ") + word;
      continue;
    }
    std::string type;
    words >> type;
    if (type != "aij" && type != "baij" && type != "sbaij") {
      throw InputError(fmt::format("-mat_type: found \"{}\", expected aij, baij or sbaij", type));
    }
    options.petsc_matrix = type == "aij"    ? PetscMatrixType::aij
                           : type == "baij" ? PetscMatrixType::baij
                                            : PetscMatrixType::sbaij;
  }
  return options;
}

std::unique_ptr<LinearSolver> make_linear_solver(const LinearSolverOptions& options) {
  switch (options.kind) {
    case LinearSolverKind::conjugate_gradient:
      return std::make_unique<ConjugateGradientSolver>(options);
    case LinearSolverKind::sparse_cholesky:
      return std::make_unique<SparseCholeskySolver>();
    case LinearSolverKind::sparse_ldlt:
      return std::make_unique<SparseLdltSolver>();
    case LinearSolverKind::sparse_lu:
      return std::make_unique<SparseLuSolver>();
    case LinearSolverKind::eigen_conjugate_gradient:
      return std::make_unique<EigenConjugateGradientSolver>(options);
    case LinearSolverKind::eigen_sparse_lu:
      return std::make_unique<EigenSparseLuSolver>();
    case LinearSolverKind::cholmod:
      return std::make_unique<CholmodSolver>();
    case LinearSolverKind::petsc:
      return std::make_unique<PetscSolver>(options);
  }
  return nullptr;
}

std::unique_ptr<LinearSolver> default_direct_solver() {
  return make_linear_solver({.kind = LinearSolverKind::sparse_lu});
}

bool LinearSolver::take_matrix(const SparseMatrix& A) {
  const bool is_new = analyses_ == 0 || !sparse::same_pattern(matrix_, A);
  matrix_ = A;  // an unchanged pattern keeps its storage
  if (is_new) ++analyses_;
  return is_new;
}

}  // namespace fw::linalg
