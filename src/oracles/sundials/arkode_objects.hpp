#pragma once

#include <arkode/arkode_arkstep.h>
#include <arkode/arkode_mristep.h>
#include <ida/ida.h>

#include "oracles/sundials/eigen_vector.hpp"
#include "oracles/sundials/sparse_direct_solver.hpp"

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

}  // namespace fw::oracles::detail
