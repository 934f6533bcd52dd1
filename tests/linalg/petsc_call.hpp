#pragma once

#include <functional>
#include <string>

#include "core/error.hpp"
#include "linalg/petsc_solver.hpp"

namespace fw::linalg {

/// The linear solver petsc with options in PETSc's notation.
inline LinearSolverOptions petsc(const std::string& options, PetscMatrixType storage = PetscMatrixType::aij) {
  return {.kind = LinearSolverKind::petsc,
          .relative_tolerance = 1e-10,
          .petsc_options = options,
          .petsc_matrix = storage};
}

/// The message of the InputError that a call ends with.
inline std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no InputError";
}

}  // namespace fw::linalg
