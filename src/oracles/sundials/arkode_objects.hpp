#pragma once

#include <arkode/arkode_arkstep.h>
#include <arkode/arkode_mristep.h>
#include <ida/ida.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_sparse.h>

#include <algorithm>

#include "oracles/sundials/sundials_objects.hpp"

namespace fw::oracles::detail {

/// Owners of the objects of ARKODE and IDA.
struct ArkStepDeleter {
  void operator()(void* memory) const { ARKStepFree(&memory); }
};
struct MriStepDeleter {
  void operator()(void* memory) const { MRIStepFree(&memory); }
};
struct InnerStepperDeleter {
  void operator()(MRIStepInnerStepper stepper) const { MRIStepInnerStepper_Free(&stepper); }
};
struct ButcherTableDeleter {
  void operator()(ARKodeButcherTable table) const { ARKodeButcherTable_Free(table); }
};
struct CouplingDeleter {
  void operator()(MRIStepCoupling coupling) const { MRIStepCoupling_Free(coupling); }
};
struct IdaDeleter {
  void operator()(void* memory) const { IDAFree(&memory); }
};

using ArkStepPointer = std::unique_ptr<void, ArkStepDeleter>;
using MriStepPointer = std::unique_ptr<void, MriStepDeleter>;
using InnerStepperPointer = std::unique_ptr<std::remove_pointer_t<MRIStepInnerStepper>, InnerStepperDeleter>;
using ButcherTablePointer = std::unique_ptr<std::remove_pointer_t<ARKodeButcherTable>, ButcherTableDeleter>;
using CouplingPointer = std::unique_ptr<std::remove_pointer_t<MRIStepCoupling>, CouplingDeleter>;
using IdaPointer = std::unique_ptr<void, IdaDeleter>;

/// The pointer that a SUNDIALS constructor has returned; SystemError where it is null.
template <class Pointer>
Pointer made(Pointer object, const char* call) {
  if (object == nullptr) throw SystemError(std::string("SUNDIALS: ") + call + " returned nothing");
  return object;
}

/// An N_Vector over `entries`, which are not copied and have to outlive it.
inline VectorPointer wrap_entries(VectorRef entries, SUNContext context) {
  return VectorPointer(made(N_VMake_Serial(entries.size(), entries.data(), context), "N_VMake_Serial"));
}

/// A sparse matrix and KLU for it.
struct KluSolver {
  KluSolver(const SparseMatrix& pattern, N_Vector like, SUNContext context)
      : matrix(made(SUNSparseMatrix(pattern.rows(), pattern.cols(), pattern.nonZeros(), CSC_MAT, context),
                    "SUNSparseMatrix")),
        solver(made(SUNLinSol_KLU(like, matrix.get(), context), "SUNLinSol_KLU")) {}

  MatrixPointer matrix;
  LinearSolverPointer solver;
};

/// Copies pattern and values; SUNDIALS clears a matrix, pattern included, before it asks for its entries.
inline void copy_matrix(const SparseMatrix& source, SUNMatrix target) {
  std::copy_n(source.outerIndexPtr(), source.cols() + 1, SUNSparseMatrix_IndexPointers(target));
  std::copy_n(source.innerIndexPtr(), source.nonZeros(), SUNSparseMatrix_IndexValues(target));
  std::copy_n(source.valuePtr(), source.nonZeros(), SUNSparseMatrix_Data(target));
}

}  // namespace fw::oracles::detail
