#pragma once

#include <sundials/sundials_context.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_nonlinearsolver.h>
#include <sundials/sundials_nvector.h>

#include <memory>
#include <string>
#include <type_traits>

#include "core/error.hpp"
#include "core/types.hpp"

namespace fw::oracles::detail {

/// Owners of SUNDIALS objects, so that every way out of a run frees them.
struct ContextDeleter {
  void operator()(SUNContext context) const { SUNContext_Free(&context); }
};
struct VectorDeleter {
  void operator()(N_Vector vector) const { N_VDestroy(vector); }
};
struct MatrixDeleter {
  void operator()(SUNMatrix matrix) const { SUNMatDestroy(matrix); }
};
struct LinearSolverDeleter {
  void operator()(SUNLinearSolver solver) const { SUNLinSolFree(solver); }
};
struct NonlinearSolverDeleter {
  void operator()(SUNNonlinearSolver solver) const { SUNNonlinSolFree(solver); }
};

using ContextPointer = std::unique_ptr<std::remove_pointer_t<SUNContext>, ContextDeleter>;
using VectorPointer = std::unique_ptr<std::remove_pointer_t<N_Vector>, VectorDeleter>;
using MatrixPointer = std::unique_ptr<std::remove_pointer_t<SUNMatrix>, MatrixDeleter>;
using LinearSolverPointer = std::unique_ptr<std::remove_pointer_t<SUNLinearSolver>, LinearSolverDeleter>;
using NonlinearSolverPointer =
    std::unique_ptr<std::remove_pointer_t<SUNNonlinearSolver>, NonlinearSolverDeleter>;

inline ContextPointer make_context() {
  SUNContext context = nullptr;
  if (SUNContext_Create(nullptr, &context) != 0) throw SystemError("SUNDIALS cannot create its context");
  return ContextPointer(context);
}

/// A SUNDIALS call that can only fail for want of memory or by a programming error.
inline void require(int flag, const char* call) {
  if (flag < 0)
    throw SystemError(std::string("SUNDIALS: ") + call + " failed with flag " + std::to_string(flag));
}

/// The owner of what a SUNDIALS constructor has returned; a null pointer is a failure of `call`.
template <class Owner>
Owner own(typename Owner::pointer object, const char* call) {
  if (object == nullptr) throw SystemError(std::string("SUNDIALS: ") + call + " returned nothing");
  return Owner(object);
}

/// The entries of an N_Vector as an Eigen vector, without a copy.
inline ConstVectorMap view(N_Vector vector, Index size) {
  return {N_VGetArrayPointer(vector), size};
}
inline VectorMap mutable_view(N_Vector vector, Index size) {
  return {N_VGetArrayPointer(vector), size};
}

}  // namespace fw::oracles::detail
