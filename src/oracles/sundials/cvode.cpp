#include "oracles/sundials/cvode.hpp"

#include <cvodes/cvodes.h>
#include <fmt/format.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_sparse.h>

#include <algorithm>
#include <string>

#include "oracles/sundials/sundials_objects.hpp"

namespace fw::oracles {

namespace {

using namespace detail;

struct CvodeDeleter {
  void operator()(void* memory) const { CVodeFree(&memory); }
};
using CvodePointer = std::unique_ptr<void, CvodeDeleter>;

/// Relative tolerances below this drown in rounding.
constexpr double smallest_relative_tolerance = 1e-13;
constexpr int max_steps_without_progress = 20;

/// What CVODE's callbacks need; one per run.
struct Run {
  const OdeSystem& system;
  Work& work;
  SparseMatrix jacobian;
  std::string message;  ///< CVODE's last error message
};

int evaluate_rhs(sunrealtype t, N_Vector y, N_Vector dydt, void* user_data) {
  auto& run = *static_cast<Run*>(user_data);
  const Index n = run.system.size();
  VectorMap slope = mutable_view(dydt, n);
  run.system.rhs(t, view(y, n), slope);
  ++run.work.rhs_evaluations;
  return slope.allFinite() ? 0 : 1;  // 1: recoverable, CVODE tries a smaller step
}

int evaluate_jacobian(sunrealtype t, N_Vector y, N_Vector, SUNMatrix J, void* user_data, N_Vector, N_Vector,
                      N_Vector) {
  auto& run = *static_cast<Run*>(user_data);
  run.system.jacobian(t, view(y, run.system.size()), run.jacobian);
  ++run.work.jacobian_evaluations;
  // CVODE clears the matrix, pattern included, before each call.
  const SparseMatrix& source = run.jacobian;
  std::copy_n(source.outerIndexPtr(), source.cols() + 1, SUNSparseMatrix_IndexPointers(J));
  std::copy_n(source.innerIndexPtr(), source.nonZeros(), SUNSparseMatrix_IndexValues(J));
  std::copy_n(source.valuePtr(), source.nonZeros(), SUNSparseMatrix_Data(J));
  return 0;
}

void keep_message(int, const char*, const char*, char* text, void* user_data) {
  static_cast<Run*>(user_data)->message = text;
}

Status status_of_flag(int flag, const Run& run, double t) {
  const auto with_reason = [&](StatusCode code) {
    char* name = CVodeGetReturnFlagName(flag);
    std::string message =
        fmt::format("CVODE at t = {:.6g}: {}{}{}", t, name, run.message.empty() ? "" : ": ", run.message);
    std::free(name);
    return Status{code, std::move(message)};
  };
  switch (flag) {
    case CV_TOO_MUCH_WORK:
      return with_reason(StatusCode::step_limit);
    case CV_ERR_FAILURE:
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

class CvodeBdf final : public Integrator {
 public:
  explicit CvodeBdf(const CvodeOptions& options) : options_(options) {}

  const MethodInfo& info() const override { return info_; }
  const ExtendedSolver& extended_solver() const override { return no_extended_solver_; }

 private:
  Solution do_solve(const Ivp& ivp, const StepControl& control, Observer& observer) const override {
    const auto* tolerances = std::get_if<AdaptiveStep>(&control);
    if (tolerances == nullptr) {
      throw InputError(
          fmt::format("method \"{}\" chooses its own steps: give tolerances, not a step", info_.name));
    }
    if (!(tolerances->relative_tolerance > 0.0) || !(tolerances->absolute_tolerance > 0.0)) {
      throw InputError(fmt::format("tolerances: found {} and {}, expected both > 0",
                                   tolerances->relative_tolerance, tolerances->absolute_tolerance));
    }
    const Index n = ivp.system->size();
    const std::function<void(double, VectorRef)> no_dense_output;
    Solution solution;
    solution.time = ivp.t0;
    solution.state = ivp.y0;
    if (!observer.observe({0, ivp.t0, ivp.y0, false, no_dense_output})) {
      solution.status = {StatusCode::stopped_by_observer, "stopped at the start"};
      return solution;
    }

    const ContextPointer context = make_context();
    Run run{*ivp.system, solution.work, ivp.system->jacobian_pattern(), {}};
    const VectorPointer y(N_VMake_Serial(n, solution.state.data(), context.get()));
    const VectorPointer dense(N_VNew_Serial(n, context.get()));
    const MatrixPointer matrix(SUNSparseMatrix(n, n, run.jacobian.nonZeros(), CSC_MAT, context.get()));
    const LinearSolverPointer linear_solver(SUNLinSol_KLU(y.get(), matrix.get(), context.get()));
    const CvodePointer cvode(CVodeCreate(CV_BDF, context.get()));
    if (!y || !dense || !matrix || !linear_solver || !cvode) throw SystemError("SUNDIALS: out of memory");
    void* memory = cvode.get();
    require(CVodeSetErrHandlerFn(memory, keep_message, &run), "CVodeSetErrHandlerFn");
    require(CVodeInit(memory, evaluate_rhs, ivp.t0, y.get()), "CVodeInit");
    require(CVodeSetUserData(memory, &run), "CVodeSetUserData");
    const double relative = std::min(
        tolerances->relative_tolerance,
        std::max(tolerances->relative_tolerance * options_.tolerance_factor, smallest_relative_tolerance));
    require(CVodeSStolerances(memory, relative, tolerances->absolute_tolerance * options_.tolerance_factor),
            "CVodeSStolerances");
    require(CVodeSetLinearSolver(memory, linear_solver.get(), matrix.get()), "CVodeSetLinearSolver");
    require(CVodeSetJacFn(memory, evaluate_jacobian), "CVodeSetJacFn");
    require(CVodeSetMaxNumSteps(memory, -1), "CVodeSetMaxNumSteps");
    require(CVodeSetStopTime(memory, ivp.t1), "CVodeSetStopTime");
    if (tolerances->initial_step > 0.0)
      require(CVodeSetInitStep(memory, tolerances->initial_step), "CVodeSetInitStep");
    if (tolerances->minimum_step > 0.0)
      require(CVodeSetMinStep(memory, tolerances->minimum_step), "CVodeSetMinStep");
    if (std::isfinite(tolerances->maximum_step))
      require(CVodeSetMaxStep(memory, tolerances->maximum_step), "CVodeSetMaxStep");

    const std::function<void(double, VectorRef)> interpolate = [&](double t, VectorRef out) {
      require(CVodeGetDky(memory, t, 0, dense.get()), "CVodeGetDky");
      out = view(dense.get(), n);
    };
    double t = ivp.t0;
    int steps_without_progress = 0;
    for (std::uint64_t step = 1;; ++step) {
      if (step > tolerances->maximum_steps) {
        solution.status = {StatusCode::step_limit,
                           fmt::format("{} steps did not reach the end: stopped at t = {:.6g}", step - 1, t)};
        break;
      }
      const double t_before = t;
      const int flag = CVode(memory, ivp.t1, y.get(), &t, CV_ONE_STEP);
      if (flag < 0) {
        solution.status = status_of_flag(flag, run, t);
        break;
      }
      // CVODE only warns of steps below the rounding of t and would go on with them for ever.
      steps_without_progress = t > t_before ? 0 : steps_without_progress + 1;
      if (steps_without_progress == max_steps_without_progress) {
        solution.status = {
            StatusCode::step_too_small,
            fmt::format("CVODE at t = {:.6g}: the step fell below the rounding of t: {}", t, run.message)};
        break;
      }
      const bool last = flag == CV_TSTOP_RETURN || t >= ivp.t1;
      if (!observer.observe({step, t, solution.state, last, interpolate}) && !last) {
        solution.status = {StatusCode::stopped_by_observer, fmt::format("stopped at t = {:.6g}", t)};
        break;
      }
      if (last) break;
    }
    solution.time = t;
    collect_work(memory, solution.work);
    return solution;
  }

  static void collect_work(void* memory, Work& work) {
    long steps = 0, error_failures = 0, setups = 0, newton = 0, newton_failures = 0;
    CVodeGetNumSteps(memory, &steps);
    CVodeGetNumErrTestFails(memory, &error_failures);
    CVodeGetNumLinSolvSetups(memory, &setups);
    CVodeGetNonlinSolvStats(memory, &newton, &newton_failures);
    work.accepted_steps = static_cast<std::uint64_t>(steps);
    work.rejected_steps = static_cast<std::uint64_t>(error_failures + newton_failures);
    work.factorisations = static_cast<std::uint64_t>(setups);
    work.newton_iterations = work.linear_solves = static_cast<std::uint64_t>(newton);
  }

  CvodeOptions options_;
  ExtendedSolver no_extended_solver_;
  MethodInfo info_{
      .name = "sundials:cvode_bdf",
      .title = "CVODE, variable-order BDF with Newton and KLU",
      .family = "oracle",
      .order = 0,
      .order_with_velocity_forces = 0,
      .stages = 1,
      .is_explicit = false,
      .is_multistep = true,
      .is_adaptive = true,
      .has_fixed_step = false,
      .formula = "backward differentiation formulas of orders 1-5, steps and order chosen by error",
      .reference = "[Hindmarsh et al. 2005]"};
};

}  // namespace

std::unique_ptr<Integrator> make_cvode_bdf(const CvodeOptions& options) {
  return std::make_unique<CvodeBdf>(options);
}

}  // namespace fw::oracles
