#include "oracles/sundials/cvode_session.hpp"

#include <cvodes/cvodes.h>
#include <fmt/format.h>
#include <sunlinsol/sunlinsol_spgmr.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <cmath>
#include <cstdlib>

#include "integrators/loop/particle_norm.hpp"
#include "oracles/sundials/eigen_vector.hpp"

namespace fw::oracles::detail {

namespace {

/// CVODE only warns of steps below the rounding of t and would go on with them for ever.
constexpr int most_steps_without_progress = 10;

CvodeSession& session(void* user_data) {
  return *static_cast<CvodeSession*>(user_data);
}

int rhs(sunrealtype t, N_Vector y, N_Vector slope, void* user_data) {
  return session(user_data).guard().call([&] { return session(user_data).evaluate_rhs(t, y, slope); });
}

int jacobian(sunrealtype t, N_Vector y, N_Vector, SUNMatrix J, void* user_data, N_Vector, N_Vector,
             N_Vector) {
  return session(user_data).guard().call([&] { return session(user_data).evaluate_jacobian(t, y, J); });
}

int jacobian_product(N_Vector w, N_Vector out, sunrealtype t, N_Vector y, N_Vector, void* user_data,
                     N_Vector) {
  return session(user_data).guard().call([&] { return session(user_data).multiply_jacobian(t, y, w, out); });
}

int preconditioner_setup(sunrealtype t, N_Vector y, N_Vector, booleantype blocks_are_current,
                         booleantype* blocks_taken, sunrealtype gamma, void* user_data) {
  return session(user_data).guard().call([&] {
    bool taken = false;
    const int flag =
        session(user_data).set_up_preconditioner(t, y, blocks_are_current != SUNFALSE, taken, gamma);
    *blocks_taken = taken ? SUNTRUE : SUNFALSE;
    return flag;
  });
}

int preconditioner_solve(sunrealtype, N_Vector, N_Vector, N_Vector r, N_Vector z, sunrealtype, sunrealtype,
                         int, void* user_data) {
  return session(user_data).guard().call([&] { return session(user_data).apply_preconditioner(r, z); });
}

void error_handler(int, const char*, const char*, char* text, void* user_data) {
  session(user_data).guard().call([&] {
    session(user_data).keep_message(text);
    return 0;
  });
}

}  // namespace

void CvodeSession::MemoryDeleter::operator()(void* memory) const {
  CVodeFree(&memory);
}

CvodeSession::CvodeSession(CvodeFormula formula, const CvodeOptions& options, const Ivp& ivp,
                           const AdaptiveStep& tolerances, Work& work)
    : system_(*ivp.system), work_(work), state_(ivp.y0), stop_time_(ivp.t1), context_(make_context()) {
  y_ = wrap_state(state_, integrators::has_particles(system_), options.vector, context_.get());
  dense_ = new_vector(state_.size(), options.vector, context_.get());
  memory_.reset(CVodeCreate(formula == CvodeFormula::bdf ? CV_BDF : CV_ADAMS, context_.get()));
  if (memory_ == nullptr) throw SystemError("SUNDIALS: CVodeCreate returned nothing");
  require(CVodeSetErrHandlerFn(memory(), error_handler, this), "CVodeSetErrHandlerFn");
  require(CVodeInit(memory(), rhs, ivp.t0, y_.get()), "CVodeInit");
  require(CVodeSetUserData(memory(), this), "CVodeSetUserData");
  Vector absolute = absolute_tolerances(tolerances, system_);
  const VectorPointer absolute_vector = wrap_vector(absolute, options.vector, context_.get());
  require(CVodeSVtolerances(memory(), tolerances.relative_tolerance, absolute_vector.get()),
          "CVodeSVtolerances");
  if (iteration_of(formula, options) == CvodeIteration::newton) {
    attach_linear_solver(options);
  } else {
    fixed_point_ = own<NonlinearSolverPointer>(SUNNonlinSol_FixedPoint(y_.get(), 0, context_.get()),
                                               "SUNNonlinSol_FixedPoint");
    require(CVodeSetNonlinearSolver(memory(), fixed_point_.get()), "CVodeSetNonlinearSolver");
  }
  if (options.maximum_order > 0) require(CVodeSetMaxOrd(memory(), options.maximum_order), "CVodeSetMaxOrd");
  if (options.stability_limit_detection) require(CVodeSetStabLimDet(memory(), SUNTRUE), "CVodeSetStabLimDet");
  require(CVodeSetMaxNumSteps(memory(), -1), "CVodeSetMaxNumSteps");
  require(CVodeSetStopTime(memory(), stop_time_), "CVodeSetStopTime");
  if (tolerances.initial_step > 0.0)
    require(CVodeSetInitStep(memory(), tolerances.initial_step), "CVodeSetInitStep");
  if (tolerances.minimum_step > 0.0)
    require(CVodeSetMinStep(memory(), tolerances.minimum_step), "CVodeSetMinStep");
  if (std::isfinite(tolerances.maximum_step))
    require(CVodeSetMaxStep(memory(), tolerances.maximum_step), "CVodeSetMaxStep");
}

void CvodeSession::attach_linear_solver(const CvodeOptions& options) {
  if (options.linear_solver == CvodeLinearSolver::klu) {
    jacobian_ = system_.jacobian_pattern();
    watch_.emplace(system_.pattern_revision());
    direct_.emplace(jacobian_, y_.get(), context_.get());
    require(CVodeSetLinearSolver(memory(), direct_->solver(), direct_->matrix()), "CVodeSetLinearSolver");
    require(CVodeSetJacFn(memory(), jacobian), "CVodeSetJacFn");
    return;
  }
  preconditioner_.emplace(system_);
  krylov_ = own<LinearSolverPointer>(
      SUNLinSol_SPGMR(y_.get(), SUN_PREC_LEFT, options.krylov_dimension, context_.get()), "SUNLinSol_SPGMR");
  require(CVodeSetLinearSolver(memory(), krylov_.get(), nullptr), "CVodeSetLinearSolver");
  require(CVodeSetJacTimes(memory(), nullptr, jacobian_product), "CVodeSetJacTimes");
  require(CVodeSetPreconditioner(memory(), preconditioner_setup, preconditioner_solve),
          "CVodeSetPreconditioner");
}

int CvodeSession::evaluate_rhs(double t, N_Vector y, N_Vector slope) {
  VectorMap out = mutable_view(slope, state_.size());
  system_.rhs(t, view(y, state_.size()), out);
  ++work_.rhs_evaluations;
  return out.allFinite() ? 0 : 1;  // 1: recoverable, CVODE tries a smaller step
}

int CvodeSession::evaluate_jacobian(double t, N_Vector y, SUNMatrix J) {
  if (watch_->has_changed(system_.pattern_revision())) jacobian_ = system_.jacobian_pattern();
  system_.jacobian(t, view(y, state_.size()), jacobian_);
  ++work_.jacobian_evaluations;
  direct_->copy(jacobian_, J);
  // KLU's factors of a matrix that is not finite look like success.
  return jacobian_.coeffs().allFinite() ? 0 : 1;
}

int CvodeSession::multiply_jacobian(double t, N_Vector y, N_Vector w, N_Vector out) {
  VectorMap product = mutable_view(out, state_.size());
  system_.jacobian_product(t, view(y, state_.size()), view(w, state_.size()), product);
  ++work_.jacobian_products;
  return product.allFinite() ? 0 : 1;
}

int CvodeSession::set_up_preconditioner(double t, N_Vector y, bool blocks_are_current, bool& blocks_taken,
                                        double gamma) {
  blocks_taken = !blocks_are_current;
  if (blocks_taken) preconditioner_->evaluate(t, view(y, state_.size()), work_);
  return preconditioner_->factorise(gamma) ? 0 : 1;
}

int CvodeSession::apply_preconditioner(N_Vector r, N_Vector z) {
  VectorMap out = mutable_view(z, state_.size());
  preconditioner_->solve(view(r, state_.size()), out);
  return 0;
}

Status CvodeSession::advance(double limit, double& t, VectorRef y, CvodeEvent* event) {
  if (limit != stop_time_) {
    stop_time_ = limit;
    require(CVodeSetStopTime(memory(), limit), "CVodeSetStopTime");
  }
  const double t_before = t;
  const int flag = CVode(memory(), limit, y_.get(), &t, CV_ONE_STEP);
  guard_.rethrow();
  if (flag < 0) return status_of_flag(flag, t);
  steps_without_progress_ = t > t_before ? 0 : steps_without_progress_ + 1;
  if (steps_without_progress_ == most_steps_without_progress) {
    return {StatusCode::step_too_small,
            fmt::format("CVODE at t = {:.6g}: the step fell below the rounding of t: {}", t, message_)};
  }
  y = state_;
  if (event != nullptr) *event = flag == CV_ROOT_RETURN ? CvodeEvent::root : CvodeEvent::step;
  return {};
}

void CvodeSession::interpolate(double t, VectorRef out) {
  require(CVodeGetDky(memory(), t, 0, dense_.get()), "CVodeGetDky");
  out = view(dense_.get(), state_.size());
}

void CvodeSession::restart(double t, ConstVectorRef y) {
  collect_work(work_);
  state_ = y;
  require(CVodeReInit(memory(), t, y_.get()), "CVodeReInit");
  if (direct_) direct_->forget();
  require(CVodeSetStopTime(memory(), stop_time_), "CVodeSetStopTime");
  steps_without_progress_ = 0;
  message_.clear();
}

void CvodeSession::collect_work(Work& work) const {
  long error_failures = 0, setups = 0, iterations = 0, iteration_failures = 0;
  CVodeGetNumErrTestFails(memory(), &error_failures);
  CVodeGetNumLinSolvSetups(memory(), &setups);
  CVodeGetNonlinSolvStats(memory(), &iterations, &iteration_failures);
  work.rejected_steps += static_cast<std::uint64_t>(error_failures + iteration_failures);
  if (fixed_point_ != nullptr) return;
  work.newton_iterations += static_cast<std::uint64_t>(iterations);
  work.linear_solves += static_cast<std::uint64_t>(iterations);
  if (krylov_ == nullptr) {
    work.factorisations += static_cast<std::uint64_t>(setups);
    return;
  }
  long linear_iterations = 0;
  CVodeGetNumLinIters(memory(), &linear_iterations);
  work.linear_iterations += static_cast<std::uint64_t>(linear_iterations);
}

Status CvodeSession::status_of_flag(int flag, double t) const {
  const auto with_reason = [&](StatusCode code) {
    char* name = CVodeGetReturnFlagName(flag);
    std::string text =
        fmt::format("CVODE at t = {:.6g}: {}{}{}", t, name, message_.empty() ? "" : ": ", message_);
    std::free(name);
    return Status{code, std::move(text)};
  };
  switch (flag) {
    case CV_TOO_MUCH_WORK:
      return with_reason(StatusCode::step_limit);
    case CV_ERR_FAILURE:
    case CV_TOO_MUCH_ACC:
      return with_reason(StatusCode::step_too_small);
    case CV_CONV_FAILURE:
      return with_reason(StatusCode::newton_failed);
    case CV_LSETUP_FAIL:
      return with_reason(StatusCode::matrix_singular);
    case CV_LSOLVE_FAIL:
      return with_reason(StatusCode::linear_solver_failed);
    case CV_FIRST_RHSFUNC_ERR:
    case CV_REPTD_RHSFUNC_ERR:
    case CV_UNREC_RHSFUNC_ERR:
      return with_reason(StatusCode::non_finite);
    default:
      return with_reason(StatusCode::library_failure);
  }
}

}  // namespace fw::oracles::detail
