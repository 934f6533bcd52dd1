#include "oracles/sundials/ida_memory.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace fw::oracles::detail {

IdaMemory::IdaMemory(std::unique_ptr<DaeForm> form, double t0, double t1, const Vector& y0,
                     const Vector& dydt0, const AdaptiveStep& tolerances, Work& work)
    : form_(std::move(form)),
      start_(t0),
      stop_time_(t1),
      relative_tolerance_(tolerances.relative_tolerance),
      absolute_tolerances_(form_->tolerances(tolerances)),
      work_(work),
      check_stall_(t0),
      state_(y0),
      slope_(dydt0),
      dense_(y0.size()),
      kinds_(Vector::Ones(y0.size())),
      context_(make_context()),
      state_vector_(wrap_state(state_, form_->is_of_particles(), VectorOperations::eigen, context_.get())),
      slope_vector_(wrap_eigen_vector(slope_, context_.get())),
      dense_vector_(wrap_eigen_vector(dense_, context_.get())),
      kinds_vector_(wrap_eigen_vector(kinds_, context_.get())),
      linear_solver_(form_->pattern(), state_vector_.get(), context_.get()),
      memory_(own<IdaPointer>(IDACreate(context_.get()), "IDACreate")) {
  void* memory = memory_.get();
  require(IDASetErrHandlerFn(memory, keep_message, &report_), "IDASetErrHandlerFn");
  require(IDAInit(memory, residual_function, t0, state_vector_.get(), slope_vector_.get()), "IDAInit");
  require(IDASetUserData(memory, this), "IDASetUserData");
  const VectorPointer absolute_vector = wrap_eigen_vector(absolute_tolerances_, context_.get());
  require(IDASVtolerances(memory, tolerances.relative_tolerance, absolute_vector.get()), "IDASVtolerances");
  require(IDASetLinearSolver(memory, linear_solver_.solver(), linear_solver_.matrix()), "IDASetLinearSolver");
  require(IDASetJacFn(memory, jacobian_function), "IDASetJacFn");
  require(IDASetMaxNumSteps(memory, -1), "IDASetMaxNumSteps");
  require(IDASetStopTime(memory, t1), "IDASetStopTime");
  if (tolerances.initial_step > 0.0) {
    require(IDASetInitStep(memory, tolerances.initial_step), "IDASetInitStep");
  }
  if (tolerances.minimum_step > 0.0) {
    require(IDASetMinStep(memory, tolerances.minimum_step), "IDASetMinStep");
  }
  if (std::isfinite(tolerances.maximum_step)) {
    require(IDASetMaxStep(memory, tolerances.maximum_step), "IDASetMaxStep");
  }
}

void IdaMemory::set_kinds(const Vector& is_differential) {
  kinds_ = is_differential;
  require(IDASetId(get(), kinds_vector_.get()), "IDASetId");
  require(IDASetSuppressAlg(get(), SUNTRUE), "IDASetSuppressAlg");
}

void IdaMemory::set_tolerances_per_step(const Vector& scale) {
  scale_per_step_ = scale;
  require(IDAWFtolerances(get(), error_weights), "IDAWFtolerances");
}

int IdaMemory::error_weights(N_Vector y, N_Vector weights, void* self) {
  auto& run = *static_cast<IdaMemory*>(self);
  return run.report_.guard.call([&] {
    double step = 0.0;  // 0 before the first one
    IDAGetCurrentStep(run.get(), &step);
    const Index n = run.form_->size();
    VectorMap weight = mutable_view(weights, n);
    weight = run.relative_tolerance_ * view(y, n).cwiseAbs();
    weight += run.absolute_tolerances_;
    if (step > 0.0) weight += run.absolute_tolerances_.cwiseProduct(run.scale_per_step_) / step;
    weight = weight.cwiseInverse();
    return weight.allFinite() ? 0 : -1;
  });
}

Status IdaMemory::correct_initial_values(double first_output) {
  const int flag = IDACalcIC(get(), IDA_YA_YDP_INIT, first_output);
  report_.guard.rethrow();
  if (flag < 0) return failure(flag, start_);
  require(IDAGetConsistentIC(get(), state_vector_.get(), slope_vector_.get()), "IDAGetConsistentIC");
  report_.met_non_finite = false;
  return {};
}

Status IdaMemory::advance(double limit, double& t) {
  report_.message.clear();
  if (limit != stop_time_) {
    stop_time_ = limit;
    require(IDASetStopTime(get(), limit), "IDASetStopTime");
  }
  const int flag = IDASolve(get(), limit, &t, state_vector_.get(), slope_vector_.get(), IDA_ONE_STEP);
  report_.guard.rethrow();
  if (flag < 0) return failure(flag, t);
  return check_stall_("IDA", t, report_);
}

void IdaMemory::restart(double t, ConstVectorRef y, ConstVectorRef dydt) {
  collect_work(work_);
  start_ = t;
  state_ = y;
  slope_ = dydt;
  require(IDAReInit(get(), t, state_vector_.get(), slope_vector_.get()), "IDAReInit");
  linear_solver_.forget();
  require(IDASetStopTime(get(), stop_time_), "IDASetStopTime");
  report_ = {};
  check_stall_ = StallCheck(t);
}

void IdaMemory::interpolate(double t, VectorRef out) {
  require(IDAGetDky(get(), t, 0, dense_vector_.get()), "IDAGetDky");
  out = dense_.head(out.size());
}

void IdaMemory::collect_work(Work& work) const {
  long error_failures = 0, solve_failures = 0, setups = 0, newton = 0;
  IDAGetNumErrTestFails(get(), &error_failures);
  IDAGetNumStepSolveFails(get(), &solve_failures);
  IDAGetNumLinSolvSetups(get(), &setups);
  IDAGetNumNonlinSolvIters(get(), &newton);
  work.rejected_steps += static_cast<std::uint64_t>(error_failures + solve_failures);
  work.factorisations += static_cast<std::uint64_t>(setups);
  work.newton_iterations += static_cast<std::uint64_t>(newton);
  work.linear_solves += static_cast<std::uint64_t>(newton);
}

Status IdaMemory::failure(int flag, double t) const {
  // Its own words, "tstop is behind current t", are of a product that underflows.
  if (flag == IDA_ILL_INPUT && report_.message.find("tstop") != std::string::npos) {
    return {StatusCode::step_too_small,
            fmt::format(
                "IDA at t = {:.6g}: what is left to the end at t = {:.6g}, {:.3g} s, is too short for it to "
                "take a step; a later end mends it, or another method",
                t, stop_time_, stop_time_ - t)};
  }
  long last_linear_flag = 0;
  IDAGetLastLinFlag(get(), &last_linear_flag);
  return describe_failure(code_of_ida_flag(flag, last_linear_flag, report_), "IDA", t,
                          IDAGetReturnFlagName(flag), report_);
}

int IdaMemory::residual_function(sunrealtype t, N_Vector y, N_Vector dydt, N_Vector residual, void* self) {
  auto& run = *static_cast<IdaMemory*>(self);
  return run.report_.guard.call([&] {
    const Index n = run.form_->size();
    VectorMap value = mutable_view(residual, n);
    run.form_->residual(t, view(y, n), view(dydt, n), value);
    ++run.work_.rhs_evaluations;
    if (value.allFinite()) return 0;
    run.report_.met_non_finite = true;
    return 1;  // recoverable: a smaller step may help
  });
}

int IdaMemory::jacobian_function(sunrealtype t, sunrealtype cj, N_Vector y, N_Vector, N_Vector, SUNMatrix J,
                                 void* self, N_Vector, N_Vector, N_Vector) {
  auto& run = *static_cast<IdaMemory*>(self);
  return run.report_.guard.call([&] {
    const SparseMatrix& jacobian = run.form_->jacobian(t, cj, view(y, run.form_->size()));
    ++run.work_.jacobian_evaluations;
    run.linear_solver_.copy(jacobian, J);
    if (jacobian.coeffs().allFinite()) return 0;
    run.report_.met_non_finite = true;
    return 1;
  });
}

}  // namespace fw::oracles::detail
