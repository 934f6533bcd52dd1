#pragma once

#include <vector>

#include "linalg/linear_solver.hpp"
#include "linalg/petsc_library.hpp"

namespace fw::linalg {

/// Our compressed columns as a matrix of PETSc. The pattern and the place of every entry are found once for a
/// pattern; new values are then written straight into PETSc's array.
class PetscMatrix {
 public:
  /// `A` is compressed and square. Storage of blocks needs 3×3 blocks: where the size is no multiple of three
  /// they are 1×1. `sbaij` takes the entries of the upper block triangle only.
  PetscMatrix(const SparseMatrix& A, PetscMatrixType type);

  /// Takes the pattern of `A`, which has the size of the first one: storage and places are made anew. The
  /// object of PETSc stays the same and its nonzero state rises, so that a preconditioner on it is analysed
  /// anew. For `aij` only, since PETSc 3.18 does not raise the state of matrices of blocks; std::logic_error
  /// for others, which are made anew.
  void set_pattern(const SparseMatrix& A);

  /// Takes the values of `A`, which has the pattern that was set last.
  void set_values(const SparseMatrix& A);

  Mat get() const { return matrix_; }
  PetscInt block_size() const { return block_size_; }

 private:
  void make_storage(const SparseMatrix& A);

  PetscMatrixType type_;
  PetscInt block_size_ = 1;
  PetscMat matrix_;
  std::vector<PetscInt> place_;  ///< of each entry of A in PETSc's array of values; −1: not stored
};

}  // namespace fw::linalg
