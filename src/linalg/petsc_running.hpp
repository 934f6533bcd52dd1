#pragma once

namespace fw::linalg {

/// Whether PETSc, and with it MPI, runs in this process, which then must not fork: a copy of MPI's
/// connections is of no use to the copy of the process. (Apart from petsc_library.hpp, which needs PETSc's
/// headers.)
bool petsc_is_running();

}  // namespace fw::linalg
