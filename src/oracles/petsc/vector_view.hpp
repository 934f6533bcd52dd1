#pragma once

#include "core/types.hpp"
#include "linalg/petsc_library.hpp"

namespace fw::oracles {

/// The entries of a PETSc vector, for reading.
class VectorView {
 public:
  explicit VectorView(Vec vector) : vector_(vector) {
    linalg::petsc_check(VecGetLocalSize(vector, &size_));
    linalg::petsc_check(VecGetArrayRead(vector, &values_));
  }
  ~VectorView() { VecRestoreArrayRead(vector_, &values_); }
  VectorView(const VectorView&) = delete;
  VectorView& operator=(const VectorView&) = delete;
  ConstVectorMap operator*() const { return {values_, size_}; }

 private:
  Vec vector_;
  PetscInt size_ = 0;
  const PetscScalar* values_ = nullptr;
};

/// The entries of a PETSc vector, for writing; what was there before is undefined.
class WritableVectorView {
 public:
  explicit WritableVectorView(Vec vector) : vector_(vector) {
    linalg::petsc_check(VecGetLocalSize(vector, &size_));
    linalg::petsc_check(VecGetArrayWrite(vector, &values_));
  }
  ~WritableVectorView() { VecRestoreArrayWrite(vector_, &values_); }
  WritableVectorView(const WritableVectorView&) = delete;
  WritableVectorView& operator=(const WritableVectorView&) = delete;
  VectorMap operator*() const { return {values_, size_}; }

 private:
  Vec vector_;
  PetscInt size_ = 0;
  PetscScalar* values_ = nullptr;
};

}  // namespace fw::oracles
