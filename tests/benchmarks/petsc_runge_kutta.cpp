#include "benchmarks/petsc_runge_kutta.hpp"

#include <fmt/format.h>
#include <petscts.h>

#include <chrono>

#include "core/error.hpp"

namespace fw::benchmarks {

namespace {

void check(PetscErrorCode code, const char* call) {
  if (code != 0) throw SystemError(fmt::format("{}: PETSc error {}", call, static_cast<int>(code)));
}

/// MPI and PETSc from the first use to the end of the program.
class PetscLibrary {
 public:
  PetscLibrary() { check(PetscInitializeNoArguments(), "PetscInitializeNoArguments"); }
  ~PetscLibrary() { PetscFinalize(); }
  PetscLibrary(const PetscLibrary&) = delete;
  PetscLibrary& operator=(const PetscLibrary&) = delete;
};

struct RightHandSide {
  const OdeSystem& system;
  Work& work;
};

PetscErrorCode evaluate(TS, PetscReal t, Vec y, Vec dydt, void* context) {
  const auto& rhs = *static_cast<RightHandSide*>(context);
  const PetscScalar* state = nullptr;
  PetscScalar* slope = nullptr;
  PetscCall(VecGetArrayRead(y, &state));
  PetscCall(VecGetArrayWrite(dydt, &slope));
  rhs.system.rhs(t, ConstVectorMap(state, rhs.system.size()), VectorMap(slope, rhs.system.size()));
  ++rhs.work.rhs_evaluations;
  PetscCall(VecRestoreArrayWrite(dydt, &slope));
  PetscCall(VecRestoreArrayRead(y, &state));
  return 0;
}

}  // namespace

Solution solve_by_petsc_5dp(const Ivp& ivp, const AdaptiveStep& step_control) {
  static const PetscLibrary library;
  const auto start = std::chrono::steady_clock::now();
  Solution solution;
  solution.state = ivp.y0;
  RightHandSide rhs{*ivp.system, solution.work};
  Vec state = nullptr;
  TS stepper = nullptr;
  check(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, static_cast<PetscInt>(solution.state.size()),
                              solution.state.data(), &state),
        "VecCreateSeqWithArray");
  check(TSCreate(PETSC_COMM_SELF, &stepper), "TSCreate");
  check(TSSetProblemType(stepper, TS_NONLINEAR), "TSSetProblemType");
  check(TSSetType(stepper, TSRK), "TSSetType");
  check(TSRKSetType(stepper, TSRK5DP), "TSRKSetType");
  check(TSSetRHSFunction(stepper, nullptr, evaluate, &rhs), "TSSetRHSFunction");
  check(TSSetTolerances(stepper, step_control.absolute_tolerance, nullptr, step_control.relative_tolerance,
                        nullptr),
        "TSSetTolerances");
  check(TSSetTime(stepper, ivp.t0), "TSSetTime");
  check(TSSetTimeStep(stepper, step_control.initial_step), "TSSetTimeStep");
  check(TSSetMaxTime(stepper, ivp.t1), "TSSetMaxTime");
  check(TSSetMaxSteps(stepper, PETSC_MAX_INT), "TSSetMaxSteps");
  check(TSSetExactFinalTime(stepper, TS_EXACTFINALTIME_MATCHSTEP), "TSSetExactFinalTime");
  check(TSSolve(stepper, state), "TSSolve");
  TSConvergedReason reason = TS_CONVERGED_ITERATING;
  check(TSGetConvergedReason(stepper, &reason), "TSGetConvergedReason");
  if (reason < 0) solution.status = {StatusCode::library_failure, TSConvergedReasons[reason]};
  PetscInt accepted = 0, rejected = 0;
  check(TSGetStepNumber(stepper, &accepted), "TSGetStepNumber");
  check(TSGetStepRejections(stepper, &rejected), "TSGetStepRejections");
  check(TSGetTime(stepper, &solution.time), "TSGetTime");
  solution.work.accepted_steps = static_cast<std::uint64_t>(accepted);
  solution.work.rejected_steps = static_cast<std::uint64_t>(rejected);
  check(TSDestroy(&stepper), "TSDestroy");
  check(VecDestroy(&state), "VecDestroy");
  solution.work.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return solution;
}

}  // namespace fw::benchmarks
