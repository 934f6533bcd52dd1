#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/state_archive.hpp"
#include "core/work.hpp"
#include "linalg/conjugate_gradient.hpp"

namespace fw::linalg {

/// A solver of A x = b for sparse A whose values change often over a run and whose pattern changes rarely.
/// Every solver compares the pattern of a new A with that of the last one: it is analysed (ordering, symbolic
/// factorisation, storage) at the first matrix and where it has changed, and only then.
class LinearSolver {
 public:
  virtual ~LinearSolver() = default;

  /// Takes the values of A and factorises them, or makes a preconditioner from them. Failures:
  /// matrix_singular (LU), matrix_indefinite (Cholesky, block-Jacobi), non_finite.
  virtual Status factorise(const SparseMatrix& A, Work& work) = 0;

  /// Takes new values of A. An iterative solver keeps the preconditioner of the last `factorise`, a direct
  /// one factorises anew, and so does any solver for a new pattern. `factorise` has succeeded before.
  virtual Status replace_matrix(const SparseMatrix& A, Work& work) = 0;

  /// Solves with the last `A`. `x` is the initial guess of an iterative solver. Every solver reports its true
  /// residual, and one that does not reach the tolerance has failed.
  virtual LinearSolve solve(ConstVectorRef b, VectorRef x, Work& work) = 0;

  /// Forgets factors and pivots: the next `factorise` works as the first one did, to the last bit.
  virtual void forget() = 0;

  /// Visits what makes `solve` and the next `factorise` give the same bits: a reading solver makes its
  /// factors anew from the matrices saved. Throws InputError for solvers of a library that does not give out
  /// its memory.
  virtual void serialise(StateArchive& archive) = 0;

  /// How often a pattern has been analysed.
  std::uint64_t analyses() const { return analyses_; }

 protected:
  /// Takes a copy of A; whether its pattern is a new one, which counts as an analysis.
  bool take_matrix(const SparseMatrix& A);

  SparseMatrix matrix_;  ///< A as it was given last

 private:
  std::uint64_t analyses_ = 0;
};

enum class LinearSolverKind {
  conjugate_gradient,        ///< own conjugate gradients; block-Jacobi preconditioner (3×3)
  sparse_cholesky,           ///< Eigen's LLᵀ with approximate minimum degree ordering
  sparse_ldlt,               ///< Eigen's LDLᵀ: symmetric, definite or not (no pivoting)
  sparse_lu,                 ///< any regular matrix; KLU [Davis, Palamadai Natarajan 2010]
  eigen_conjugate_gradient,  ///< Eigen's conjugate gradients with a diagonal preconditioner
  eigen_sparse_lu,           ///< Eigen's supernodal LU with column approximate minimum degree ordering
  cholmod,                   ///< supernodal LLᵀ of CHOLMOD [Chen, Davis, Hager, Rajamanickam 2008]
  petsc,                     ///< PETSc's KSP with options of the user
};

/// Storage of the matrix in PETSc.
enum class PetscMatrixType {
  aij,    ///< compressed rows
  baij,   ///< compressed rows of 3×3 blocks (1×1 where the size is no multiple of three)
  sbaij,  ///< the upper triangle of it, for symmetric matrices
};

struct LinearSolverOptions {
  LinearSolverKind kind = LinearSolverKind::conjugate_gradient;
  double relative_tolerance = 1e-10;  ///< ‖b − A x‖₂/‖b‖₂ of iterative solvers
  std::uint64_t max_iterations = 0;   ///< of iterative solvers; 0: ten times the number of unknowns
  /// Options in PETSc's own notation, such as "-ksp_type cg -pc_type gamg". They override everything else.
  std::string petsc_options{};
  PetscMatrixType petsc_matrix = PetscMatrixType::aij;
  /// Positions x₀, y₀, z₀, x₁, … of the particles [m], from which PETSc's algebraic multigrid takes the rigid
  /// body modes as near-null space; empty: none.
  Vector coordinates{};
};

/// What is known of a solver.
struct LinearSolverInfo {
  std::string name;   ///< as it is called, for example "cholmod"
  std::string title;  ///< for people
  LinearSolverKind kind;
  bool needs_symmetric;  ///< reads one triangle or relies on A = Aᵀ; petsc: depends on the options, so false
  bool needs_definite;   ///< fails on symmetric indefinite matrices
  bool is_iterative;
};

/// Every solver; the only place where one is registered beside its class.
const std::vector<LinearSolverInfo>& linear_solvers();

/// The solver of that name; throws InputError with the nearest name.
const LinearSolverInfo& find_linear_solver(const std::string& name);
const LinearSolverInfo& find_linear_solver(LinearSolverKind kind);

/// The names of all, for people: "cg, cholesky or lu".
std::string linear_solver_names();

/// The options of a call such as "cholmod" or "petsc -ksp_type cg -pc_type gamg -mat_type baij": a name and,
/// for petsc, options in PETSc's notation, of which -mat_type (aij, baij, sbaij) chooses the storage. Throws
/// InputError for an unknown name or storage and for options of a solver that takes none.
LinearSolverOptions read_linear_solver(const std::string& call);

std::unique_ptr<LinearSolver> make_linear_solver(const LinearSolverOptions& options);

/// The direct solver for any regular sparse matrix that implicit schemes take where nobody chooses: KLU.
std::unique_ptr<LinearSolver> default_direct_solver();

}  // namespace fw::linalg
