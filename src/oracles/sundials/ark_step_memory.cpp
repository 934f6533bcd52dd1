#include "oracles/sundials/ark_step_memory.hpp"

#include <cmath>
#include <limits>

namespace fw::oracles::detail {

ArkStepMemory::ArkStepMemory(double t0, N_Vector y0, std::unique_ptr<RightHandPart> explicit_part,
                             std::unique_ptr<RightHandPart> implicit_part, const ArkodeTables& tables,
                             RunReport& report, Work& work, SUNContext context)
    : size_(static_cast<Index>(N_VGetLength(y0))),
      context_(context),
      explicit_part_(std::move(explicit_part)),
      implicit_part_(std::move(implicit_part)),
      report_(report),
      work_(work),
      memory_(
          own<ArkStepPointer>(ARKStepCreate(explicit_part_ ? explicit_function : nullptr,
                                            implicit_part_ ? implicit_function : nullptr, t0, y0, context),
                              "ARKStepCreate")) {
  void* memory = memory_.get();
  require(ARKStepSetErrHandlerFn(memory, keep_message, &report_), "ARKStepSetErrHandlerFn");
  require(ARKStepSetUserData(memory, this), "ARKStepSetUserData");
  require(ARKStepSetTables(memory, tables.order, tables.embedded_order, tables.implicit_part.get(),
                           tables.explicit_part.get()),
          "ARKStepSetTables");
  require(ARKStepSetMaxNumSteps(memory, -1), "ARKStepSetMaxNumSteps");
  require(ARKStepSetMaxHnilWarns(memory, std::numeric_limits<int>::max()), "ARKStepSetMaxHnilWarns");
  if (implicit_part_) {
    linear_solver_.emplace(implicit_part_->pattern(), y0, context);
    require(ARKStepSetLinearSolver(memory, linear_solver_->solver(), linear_solver_->matrix()),
            "ARKStepSetLinearSolver");
    require(ARKStepSetJacFn(memory, jacobian_function), "ARKStepSetJacFn");
  }
}

void ArkStepMemory::choose_steps(const AdaptiveStep& tolerances, Vector absolute,
                                 const StageAccuracy& accuracy) {
  void* memory = memory_.get();
  const VectorPointer absolute_vector = wrap_eigen_vector(absolute, context_);
  require(ARKStepSVtolerances(memory, tolerances.relative_tolerance, absolute_vector.get()),
          "ARKStepSVtolerances");
  if (tolerances.initial_step > 0.0) {
    require(ARKStepSetInitStep(memory, tolerances.initial_step), "ARKStepSetInitStep");
  }
  if (tolerances.minimum_step > 0.0) {
    require(ARKStepSetMinStep(memory, tolerances.minimum_step), "ARKStepSetMinStep");
  }
  if (std::isfinite(tolerances.maximum_step)) {
    require(ARKStepSetMaxStep(memory, tolerances.maximum_step), "ARKStepSetMaxStep");
  }
  if (implicit_part_) {
    require(ARKStepSetNonlinConvCoef(memory, accuracy.newton_coefficient), "ARKStepSetNonlinConvCoef");
    require(ARKStepSetMaxNonlinIters(memory, 6), "ARKStepSetMaxNonlinIters");
    renew_matrix_at_each_stage();
  }
}

void ArkStepMemory::take_constant_steps(double scale, const StageAccuracy& accuracy) {
  void* memory = memory_.get();
  stage_tolerance_ = accuracy.newton_tolerance;
  scale_ = scale > 0.0 ? scale : 1.0;
  require(ARKStepSStolerances(memory, stage_tolerance_, stage_tolerance_ * scale_), "ARKStepSStolerances");
  if (!implicit_part_) return;
  require(ARKStepSetNonlinConvCoef(memory, 0.1), "ARKStepSetNonlinConvCoef");
  require(ARKStepSetMaxNonlinIters(memory, 30), "ARKStepSetMaxNonlinIters");
  renew_matrix_at_each_stage();
}

void ArkStepMemory::renew_matrix_at_each_stage() {
  require(ARKStepSetLSetupFrequency(memory_.get(), -1), "ARKStepSetLSetupFrequency");
  require(ARKStepSetJacEvalFrequency(memory_.get(), 1), "ARKStepSetJacEvalFrequency");
}

bool ArkStepMemory::raise_stage_tolerance() {
  constexpr double highest_stage_tolerance = 1e-10;
  stage_tolerance_ *= 10.0;
  if (stage_tolerance_ > highest_stage_tolerance) return false;
  require(ARKStepSStolerances(memory_.get(), stage_tolerance_, stage_tolerance_ * scale_),
          "ARKStepSStolerances");
  return true;
}

void ArkStepMemory::restart(double t, N_Vector y) {
  collect_work(work_);
  require(ARKStepReInit(memory_.get(), explicit_part_ ? explicit_function : nullptr,
                        implicit_part_ ? implicit_function : nullptr, t, y),
          "ARKStepReInit");
  if (linear_solver_) linear_solver_->forget();
}

long ArkStepMemory::last_linear_flag() const {
  long flag = 0;
  if (implicit_part_) ARKStepGetLastLinFlag(memory_.get(), &flag);
  return flag;
}

void ArkStepMemory::collect_work(Work& work) const {
  void* memory = memory_.get();
  long error_failures = 0, solve_failures = 0, setups = 0, newton = 0;
  ARKStepGetNumErrTestFails(memory, &error_failures);
  if (implicit_part_) {
    ARKStepGetNumStepSolveFails(memory, &solve_failures);
    ARKStepGetNumLinSolvSetups(memory, &setups);
    ARKStepGetNumNonlinSolvIters(memory, &newton);
  }
  work.rejected_steps += static_cast<std::uint64_t>(error_failures + solve_failures);
  work.factorisations += static_cast<std::uint64_t>(setups);
  work.newton_iterations += static_cast<std::uint64_t>(newton);
  work.linear_solves += static_cast<std::uint64_t>(newton);
}

int ArkStepMemory::evaluate(RightHandPart& part, double t, N_Vector y, N_Vector dydt) {
  return report_.guard.call([&] {
    VectorMap slope = mutable_view(dydt, size_);
    part.evaluate(t, view(y, size_), slope);
    ++work_.rhs_evaluations;
    if (slope.allFinite()) return 0;
    report_.met_non_finite = true;
    return 1;  // recoverable: a smaller step may help
  });
}

int ArkStepMemory::explicit_function(sunrealtype t, N_Vector y, N_Vector dydt, void* self) {
  auto& run = *static_cast<ArkStepMemory*>(self);
  return run.evaluate(*run.explicit_part_, t, y, dydt);
}

int ArkStepMemory::implicit_function(sunrealtype t, N_Vector y, N_Vector dydt, void* self) {
  auto& run = *static_cast<ArkStepMemory*>(self);
  return run.evaluate(*run.implicit_part_, t, y, dydt);
}

int ArkStepMemory::jacobian_function(sunrealtype t, N_Vector y, N_Vector, SUNMatrix J, void* self, N_Vector,
                                     N_Vector, N_Vector) {
  auto& run = *static_cast<ArkStepMemory*>(self);
  return run.report_.guard.call([&] {
    const SparseMatrix& jacobian = run.implicit_part_->jacobian(t, view(y, run.size_));
    ++run.work_.jacobian_evaluations;
    run.linear_solver_->copy(jacobian, J);
    if (jacobian.coeffs().allFinite()) return 0;
    run.report_.met_non_finite = true;
    return 1;
  });
}

}  // namespace fw::oracles::detail
