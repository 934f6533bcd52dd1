#include "linalg/petsc_matrix.hpp"

#include <algorithm>
#include <stdexcept>

namespace fw::linalg {

namespace {

/// A pattern by rows.
struct RowPattern {
  std::vector<PetscInt> start, column;
};

/// The rows of the pattern of `A` (blocks of `size`), columns in order; lower triangle left out if `upper`.
RowPattern row_pattern(const SparseMatrix& A, PetscInt size, bool upper) {
  const auto rows = static_cast<PetscInt>(A.rows()) / size;
  std::vector<std::vector<PetscInt>> columns(static_cast<std::size_t>(rows));
  for (int column = 0; column < static_cast<int>(A.cols()); ++column) {
    for (int k = A.outerIndexPtr()[column]; k < A.outerIndexPtr()[column + 1]; ++k) {
      const PetscInt row = A.innerIndexPtr()[k] / size;
      std::vector<PetscInt>& list = columns[static_cast<std::size_t>(row)];
      // Columns come in order, so that a block that is known already is the last one.
      if (upper && column / size < row) continue;
      if (list.empty() || list.back() != column / size) list.push_back(column / size);
    }
  }
  RowPattern pattern;
  pattern.start.push_back(0);
  for (const std::vector<PetscInt>& list : columns) {
    pattern.column.insert(pattern.column.end(), list.begin(), list.end());
    pattern.start.push_back(static_cast<PetscInt>(pattern.column.size()));
  }
  return pattern;
}

/// The place of each entry of `A` in the values of the pattern: blocks one after the other, each by columns.
std::vector<PetscInt> places(const SparseMatrix& A, const RowPattern& pattern, PetscInt size, bool upper) {
  std::vector<PetscInt> place(static_cast<std::size_t>(A.nonZeros()));
  for (int column = 0; column < static_cast<int>(A.cols()); ++column) {
    for (int k = A.outerIndexPtr()[column]; k < A.outerIndexPtr()[column + 1]; ++k) {
      const PetscInt row = A.innerIndexPtr()[k];
      PetscInt& entry = place[static_cast<std::size_t>(k)];
      entry = -1;
      if (upper && column / size < row / size) continue;
      const auto begin = pattern.column.begin() + pattern.start[static_cast<std::size_t>(row / size)];
      const auto end = pattern.column.begin() + pattern.start[static_cast<std::size_t>(row / size) + 1];
      const auto block =
          static_cast<PetscInt>(std::lower_bound(begin, end, column / size) - pattern.column.begin());
      entry = block * size * size + (column % size) * size + row % size;
    }
  }
  return place;
}

}  // namespace

PetscMatrix::PetscMatrix(const SparseMatrix& A, PetscMatrixType type)
    : type_(type), block_size_(A.cols() % 3 == 0 ? 3 : 1) {
  const PetscSession session;
  const auto n = static_cast<PetscInt>(A.cols());
  petsc_check(MatCreate(PETSC_COMM_SELF, matrix_.out()));
  petsc_check(MatSetSizes(matrix_, n, n, n, n));
  petsc_check(MatSetBlockSize(matrix_, block_size_));
  petsc_check(MatSetType(matrix_, type == PetscMatrixType::aij    ? MATSEQAIJ
                                  : type == PetscMatrixType::baij ? MATSEQBAIJ
                                                                  : MATSEQSBAIJ));
  make_storage(A);
}

void PetscMatrix::set_pattern(const SparseMatrix& A) {
  if (type_ != PetscMatrixType::aij) {
    throw std::logic_error("PETSc's matrices of blocks do not tell of a new pattern: make a new one");
  }
  const PetscSession session;
  make_storage(A);
}

void PetscMatrix::make_storage(const SparseMatrix& A) {
  const bool upper = type_ == PetscMatrixType::sbaij;
  const PetscInt stored_block = type_ == PetscMatrixType::aij ? 1 : block_size_;
  const RowPattern pattern = row_pattern(A, stored_block, upper);
  place_ = places(A, pattern, stored_block, upper);
  petsc_check(MatSetOption(matrix_, MAT_NEW_NONZERO_LOCATION_ERR, PETSC_FALSE));
  switch (type_) {
    case PetscMatrixType::aij:
      petsc_check(
          MatSeqAIJSetPreallocationCSR(matrix_, pattern.start.data(), pattern.column.data(), nullptr));
      break;
    case PetscMatrixType::baij:
      petsc_check(MatSeqBAIJSetPreallocationCSR(matrix_, block_size_, pattern.start.data(),
                                                pattern.column.data(), nullptr));
      break;
    case PetscMatrixType::sbaij:
      petsc_check(MatSeqSBAIJSetPreallocationCSR(matrix_, block_size_, pattern.start.data(),
                                                 pattern.column.data(), nullptr));
      break;
  }
  petsc_check(MatSetOption(matrix_, MAT_NEW_NONZERO_LOCATION_ERR, PETSC_TRUE));
}

void PetscMatrix::set_values(const SparseMatrix& A) {
  const PetscSession session;
  PetscScalar* values = nullptr;
  switch (type_) {
    case PetscMatrixType::aij:
      petsc_check(MatSeqAIJGetArrayWrite(matrix_, &values));
      break;
    case PetscMatrixType::baij:
      petsc_check(MatSeqBAIJGetArray(matrix_, &values));
      break;
    case PetscMatrixType::sbaij:
      petsc_check(MatSeqSBAIJGetArray(matrix_, &values));
      break;
  }
  for (std::size_t k = 0; k < place_.size(); ++k) {
    if (place_[k] >= 0) values[place_[k]] = A.valuePtr()[k];
  }
  switch (type_) {
    case PetscMatrixType::aij:
      petsc_check(MatSeqAIJRestoreArrayWrite(matrix_, &values));
      break;
    case PetscMatrixType::baij:
      petsc_check(MatSeqBAIJRestoreArray(matrix_, &values));
      break;
    case PetscMatrixType::sbaij:
      petsc_check(MatSeqSBAIJRestoreArray(matrix_, &values));
      break;
  }
  petsc_check(MatAssemblyBegin(matrix_, MAT_FINAL_ASSEMBLY));
  petsc_check(MatAssemblyEnd(matrix_, MAT_FINAL_ASSEMBLY));
}

}  // namespace fw::linalg
