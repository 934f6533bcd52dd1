#include "oracles/petsc/ts_stepper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "core/error.hpp"
#include "integrators/loop/initial_step.hpp"
#include "integrators/loop/particle_norm.hpp"

namespace fw::oracles {

using linalg::petsc_check;
using linalg::PetscFailure;
using linalg::PetscSession;

namespace {

// Newton's iteration: its error after the last correction is far below any tolerance of a run.
constexpr double newton_relative_residual = 1e-13;
constexpr double newton_relative_correction = 1e-10;
constexpr int newton_iterations = 50;
/// Of one adaptive step; each makes it at most four times shorter.
constexpr int most_rejections = 60;

/// Equal to rounding, as TSSolve has it.
bool is_close(double a, double b) {
  return std::abs(a - b) <=
         10.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(a), std::abs(b));
}

/// Options that would change the method behind its description, the interval or the steps behind the run, or
/// how failures are told, and what says it instead.
void refuse_options(const std::string& text, bool is_adaptive) {
  static const std::pair<std::string_view, std::string_view> refused[] = {
      {"-ts_dt", "the step of the run"},
      {"-ts_max_steps", "the end time of the run"},
      {"-ts_max_time", "the end time of the run"},
      {"-ts_final_time", "the end time of the run"},
      {"-ts_init_time", "the start of the run"},
      {"-ts_exact_final_time", "the end time of the run"},
      {"-ts_theta_", "the method's own options"},
      {"-ts_rk_type", "the method's own options"},
      {"-ts_bdf_order", "the method's own options"},
      {"-ts_arkimex_", "the method's own options"},
      {"-ts_rosw_type", "the method's own options"},
      {"-ts_basicsymplectic_type", "the method's own options"},
      {"-ts_alpha_", "the method's own options"},
      {"-ts_error_if_step_fails", "the status of the run"},
      {"-snes_error_if_not_converged", "the status of the run"},
      {"-ksp_error_if_not_converged", "the status of the run"}};
  std::istringstream words(text);
  bool follows_adapt_type = false;
  for (std::string word; words >> word;) {
    if (follows_adapt_type && (word == "none") == is_adaptive) {
      throw InputError(fmt::format("PETSc options \"{}\": -ts_adapt_type {}, but the run has {}", text, word,
                                   is_adaptive ? "tolerances" : "a constant step"));
    }
    follows_adapt_type = word == "-ts_adapt_type";
    for (const auto& [option, instead] : refused) {
      if (word.starts_with(option)) {
        throw InputError(fmt::format("PETSc options \"{}\": {} is given by {}", text, word, instead));
      }
    }
  }
}

/// The method's options. The error of a particle must not vanish among many that rest: where the user has not
/// chosen, its norm on particles is the maximum, the only one of PETSc's that does not average over all.
std::string options_text(const TsMethod& method, const OdeSystem& system, bool is_adaptive) {
  constexpr std::string_view norm = "-ts_adapt_wnormtype";
  const bool is_given = method.petsc_options.find(norm) != std::string::npos;
  if (!is_adaptive || is_given || !integrators::has_particles(system)) return method.petsc_options;
  return fmt::format("{}{}{} infinity", method.petsc_options, method.petsc_options.empty() ? "" : " ", norm);
}

linalg::PetscVec absolute_vector(const AdaptiveStep& tolerances, const OdeSystem& system) {
  const Vector values = absolute_tolerances(tolerances, system);
  linalg::PetscVec vector;
  PetscScalar* entries = nullptr;
  petsc_check(VecCreateSeq(PETSC_COMM_SELF, static_cast<PetscInt>(values.size()), vector.out()));
  petsc_check(VecGetArrayWrite(vector, &entries));
  VectorMap(entries, values.size()) = values;
  petsc_check(VecRestoreArrayWrite(vector, &entries));
  return vector;
}

}  // namespace

TsStepper::TsStepper(const TsMethod& method, const Ivp& ivp, const StepControl& control, Work& work)
    : name_("TS " + method.type),
      is_implicit_(method.form != TsForm::explicit_form && method.form != TsForm::hamiltonian),
      is_adaptive_(std::holds_alternative<AdaptiveStep>(control)),
      has_monitor_(method.petsc_options.find("monitor") != std::string::npos),
      t_(ivp.t0),
      method_(method),
      ivp_(ivp),
      control_(control),
      work_(work),
      text_(options_text(method, *ivp.system, is_adaptive_)) {
  create();
}

void TsStepper::create() {
  stepper_.reset();  // it has pointers to the equations
  equations_ = std::make_unique<TsEquations>(ivp_, method_.form, work_);
  double first_step = ivp_.t1 - ivp_.t0;
  const auto norm = integrators::norm_on(integrators::ErrorNorm::largest_particle, *ivp_.system);
  if (const auto* tolerances = std::get_if<AdaptiveStep>(&control_)) {
    first_step = tolerances->initial_step > 0.0
                     ? tolerances->initial_step
                     : integrators::initial_step(ivp_, *tolerances, norm, method_.order, work_);
  }
  try {
    const PetscSession session(&text_);
    petsc_check(TSCreate(PETSC_COMM_SELF, stepper_.out()));
    petsc_check(TSSetProblemType(stepper_, TS_NONLINEAR));
    petsc_check(TSSetType(stepper_, method_.type.c_str()));
    equations_->attach(stepper_);
    petsc_check(TSSetTime(stepper_, ivp_.t0));
    petsc_check(TSSetTimeStep(stepper_, first_step));
    petsc_check(TSSetMaxTime(stepper_, ivp_.t1));
    petsc_check(TSSetMaxSteps(stepper_, PETSC_MAX_INT));
    petsc_check(TSSetErrorIfStepFails(stepper_, PETSC_FALSE));
    TSAdapt adapt = nullptr;
    petsc_check(TSGetAdapt(stepper_, &adapt));
    if (const auto* tolerances = std::get_if<AdaptiveStep>(&control_)) {
      linalg::PetscVec absolute;
      // The form of second order estimates the error of positions alone.
      const bool has_velocities = method_.form != TsForm::second_order;
      if (has_velocities && tolerances->has_velocity_tolerance(*ivp_.system))
        absolute = absolute_vector(*tolerances, *ivp_.system);
      petsc_check(TSSetTolerances(stepper_, tolerances->absolute_tolerance, absolute,
                                  tolerances->relative_tolerance, nullptr));
      petsc_check(TSAdaptSetType(adapt, TSADAPTBASIC));
      petsc_check(
          TSAdaptSetStepLimits(adapt, std::max(tolerances->minimum_step, std::numeric_limits<double>::min()),
                               std::min(tolerances->maximum_step, std::numeric_limits<double>::max())));
      petsc_check(TSSetExactFinalTime(stepper_, TS_EXACTFINALTIME_MATCHSTEP));
      petsc_check(TSSetMaxStepRejections(stepper_, most_rejections));
      petsc_check(TSSetMaxSNESFailures(stepper_, -1));
    } else {
      petsc_check(TSAdaptSetType(adapt, TSADAPTNONE));
      petsc_check(TSSetExactFinalTime(stepper_, TS_EXACTFINALTIME_STEPOVER));
      petsc_check(TSSetMaxStepRejections(stepper_, 0));
      petsc_check(TSSetMaxSNESFailures(stepper_, 1));
    }
    if (is_implicit_) set_solver_defaults();
    configure(method_);
    petsc_check(TSSetUp(stepper_));
  } catch (const PetscFailure& failed) {
    throw InputError(fmt::format("{} cannot be set up: {}", name_, failed.what()));
  }
}

void TsStepper::restart(double t, ConstVectorRef y) {
  collect_work(work_);
  ivp_.t0 = t_ = t;
  ivp_.y0 = y;
  create();
}

void TsStepper::set_solver_defaults() {
  SNES newton = nullptr;
  SNESLineSearch full_steps = nullptr;
  KSP linear = nullptr;
  PC factorisation = nullptr;
  petsc_check(TSGetSNES(stepper_, &newton));
  petsc_check(SNESSetTolerances(newton, PETSC_DEFAULT, newton_relative_residual, newton_relative_correction,
                                newton_iterations, PETSC_MAX_INT));
  petsc_check(SNESGetLineSearch(newton, &full_steps));
  petsc_check(SNESLineSearchSetType(full_steps, SNESLINESEARCHBASIC));
  petsc_check(SNESGetKSP(newton, &linear));
  petsc_check(KSPSetType(linear, KSPPREONLY));
  petsc_check(KSPGetPC(linear, &factorisation));
  petsc_check(PCSetType(factorisation, PCLU));
  petsc_check(PCFactorSetMatSolverType(factorisation, MATSOLVERKLU));
}

void TsStepper::configure(const TsMethod& method) {
  refuse_options(method.petsc_options, is_adaptive_);
  if (method.configure) method.configure(stepper_);
  linalg::with_options_to_blame(text_, [&] { petsc_check(TSSetFromOptions(stepper_)); });
  PetscBool is_same = PETSC_FALSE;
  petsc_check(
      PetscObjectTypeCompare(reinterpret_cast<PetscObject>(stepper_.get()), method.type.c_str(), &is_same));
  if (is_same == PETSC_FALSE) {
    throw InputError(
        fmt::format("PETSc options \"{}\": -ts_type is chosen by the name of the method", text_.text()));
  }
}

Status TsStepper::advance(double limit, double& t, VectorRef y) {
  equations_->take_non_finite();
  TSConvergedReason reason = TS_CONVERGED_ITERATING;
  double reached = t_;
  try {
    const PetscSession session(&text_);
    petsc_check(TSSetMaxTime(stepper_, limit));
    PetscReal step = limit - t_;
    if (is_adaptive_) {
      petsc_check(TSGetTimeStep(stepper_, &step));
      if (t_ + step > limit || is_close(t_ + step, limit)) step = limit - t_;
    }
    petsc_check(TSSetTimeStep(stepper_, step));
    petsc_check(TSStep(stepper_));
    equations_->rethrow();
    petsc_check(TSGetConvergedReason(stepper_, &reason));
    petsc_check(TSGetTime(stepper_, &reached));
    if (is_first_) text_.check_all_used();
    is_first_ = false;
    if (reason < 0) return failure(reason, t_);
    if (!is_adaptive_ && std::abs(reached - limit) > 1e-6 * (limit - t_)) {
      return {StatusCode::library_failure,
              fmt::format("{} at t = {:.6g}: PETSc took a step to {:.17g} instead of {:.17g}", name_, t_,
                          reached, limit)};
    }
    if (!is_adaptive_ || is_close(reached, limit)) {
      reached = limit;
      petsc_check(TSSetTime(stepper_, limit));
    }
    if (is_adaptive_ && reached - t_ < 1e-12 * std::max(std::abs(t_), step) &&
        equations_->take_non_finite()) {
      return {StatusCode::non_finite,
              fmt::format("{} at t = {:.6g}: the right-hand side is not finite, however small the step",
                          name_, t_)};
    }
    if (has_monitor_) {
      PetscInt count = 0;
      Vec state = nullptr;
      petsc_check(TSGetStepNumber(stepper_, &count));
      petsc_check(TSGetSolution(stepper_, &state));
      petsc_check(TSMonitor(stepper_, count, reached, state));
    }
    equations_->copy_state(y);
  } catch (const PetscFailure& failed) {
    equations_->rethrow();
    Status status = linalg::status_of(failed);
    if (equations_->take_non_finite()) status.code = StatusCode::non_finite;
    status.message = fmt::format("{} at t = {:.6g}: {}", name_, t_, status.message);
    return status;
  }
  t = t_ = reached;
  return {};
}

Status TsStepper::failure(TSConvergedReason reason, double t) {
  std::string message = fmt::format("{} at t = {:.6g}: TS_{}", name_, t, TSConvergedReasons[reason]);
  StatusCode code =
      reason == TS_DIVERGED_STEP_REJECTED ? StatusCode::step_too_small : StatusCode::newton_failed;
  if (is_implicit_) {
    SNES newton = nullptr;
    KSP linear = nullptr;
    SNESConvergedReason newton_reason = SNES_CONVERGED_ITERATING;
    KSPConvergedReason linear_reason = KSP_CONVERGED_ITERATING;
    petsc_check(TSGetSNES(stepper_, &newton));
    petsc_check(SNESGetConvergedReason(newton, &newton_reason));
    petsc_check(SNESGetKSP(newton, &linear));
    petsc_check(KSPGetConvergedReason(linear, &linear_reason));
    if (newton_reason < 0) {
      message += fmt::format(", SNES_{}", SNESConvergedReasons[newton_reason]);
      if (!is_adaptive_) code = StatusCode::newton_failed;
    }
    if (newton_reason == SNES_DIVERGED_LINEAR_SOLVE) {
      message += fmt::format(", KSP_{}", KSPConvergedReasons[linear_reason]);
      if (!is_adaptive_) code = StatusCode::linear_solver_failed;
    }
  }
  if (equations_->take_non_finite()) {
    code = StatusCode::non_finite;
    message += ": the right-hand side is not finite";
  }
  return {code, message};
}

void TsStepper::interpolate(double t, VectorRef out) {
  const PetscSession session(&text_);
  equations_->interpolate(stepper_, t, out);
}

void TsStepper::collect_work(Work& work) const {
  const PetscSession session;
  PetscInt rejected = 0, newton = 0, linear = 0;
  petsc_check(TSGetStepRejections(stepper_, &rejected));
  work.rejected_steps += static_cast<std::uint64_t>(rejected);
  if (!is_implicit_) return;
  petsc_check(TSGetSNESIterations(stepper_, &newton));
  petsc_check(TSGetKSPIterations(stepper_, &linear));
  work.newton_iterations += static_cast<std::uint64_t>(newton);
  work.linear_solves += static_cast<std::uint64_t>(newton);
  SNES solver = nullptr;
  KSP krylov = nullptr;
  PetscBool is_direct = PETSC_FALSE;
  petsc_check(TSGetSNES(stepper_, &solver));
  petsc_check(SNESGetKSP(solver, &krylov));
  petsc_check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(krylov), KSPPREONLY, &is_direct));
  if (is_direct == PETSC_FALSE) work.linear_iterations += static_cast<std::uint64_t>(linear);
}

}  // namespace fw::oracles
