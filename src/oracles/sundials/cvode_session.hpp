#pragma once

#include <memory>
#include <optional>
#include <string>

#include "ode/pattern_watch.hpp"
#include "oracles/foreign_stepper.hpp"
#include "oracles/sundials/block_preconditioner.hpp"
#include "oracles/sundials/callback_guard.hpp"
#include "oracles/sundials/cvode.hpp"
#include "oracles/sundials/sparse_direct_solver.hpp"
#include "oracles/sundials/sundials_objects.hpp"

namespace fw::oracles::detail {

/// How one step of CVODE ended.
enum class CvodeEvent {
  step,  ///< a whole step
  root,  ///< a root of the functions given to CVodeRootInit, inside the step; the step itself comes later
};

/// CVODE's objects and our callbacks for one run, shared by plain runs, root finding and sensitivities. Not
/// movable: CVODE keeps its address.
class CvodeSession {
 public:
  /// `tolerances` are those that CVODE gets. `ivp` and `work` outlive the session.
  CvodeSession(CvodeFormula formula, const CvodeOptions& options, const Ivp& ivp,
               const AdaptiveStep& tolerances, Work& work);
  CvodeSession(const CvodeSession&) = delete;
  CvodeSession& operator=(const CvodeSession&) = delete;

  void* memory() const { return memory_.get(); }
  N_Vector state_vector() const { return y_.get(); }
  SUNContext context() const { return context_.get(); }
  const OdeSystem& system() const { return system_; }
  Work& work() { return work_; }
  CallbackGuard& guard() { return guard_; }

  /// One step, not beyond `limit`; on success `t` and `y` are where it ended, at the root in case of a root.
  /// Rethrows what a callback has thrown.
  Status advance(double limit, double& t, VectorRef y, CvodeEvent* event = nullptr);

  /// y(t) in the last step.
  void interpolate(double t, VectorRef out);

  /// CVodeReInit at (t, y): order 1, a first step of CVODE's choice, no history. What CVODE has counted goes
  /// to the work of the run before.
  void restart(double t, ConstVectorRef y);

  /// Adds CVODE's own counters.
  void collect_work(Work& work) const;

  // For the callbacks.
  int evaluate_rhs(double t, N_Vector y, N_Vector slope);
  int evaluate_jacobian(double t, N_Vector y, SUNMatrix J);
  int multiply_jacobian(double t, N_Vector y, N_Vector w, N_Vector out);
  int set_up_preconditioner(double t, N_Vector y, bool blocks_are_current, bool& blocks_taken, double gamma);
  int apply_preconditioner(N_Vector r, N_Vector z);
  void keep_message(const char* text) { message_ = text; }

 private:
  void attach_linear_solver(const CvodeOptions& options);
  Status status_of_flag(int flag, double t) const;

  const OdeSystem& system_;
  Work& work_;
  CallbackGuard guard_;
  std::string message_;  ///< CVODE's last message
  Vector state_;
  double stop_time_;
  int steps_without_progress_ = 0;
  SparseMatrix jacobian_;
  std::optional<PatternWatch> watch_;  ///< of the Jacobian
  std::optional<BlockPreconditioner> preconditioner_;

  ContextPointer context_;
  VectorPointer y_, dense_;
  std::optional<SparseDirectSolver> direct_;
  LinearSolverPointer krylov_;
  NonlinearSolverPointer fixed_point_;
  struct MemoryDeleter {
    void operator()(void* memory) const;
  };
  std::unique_ptr<void, MemoryDeleter> memory_;
};

/// A plain run.
class CvodeStepper final : public ForeignStepper {
 public:
  CvodeStepper(CvodeFormula formula, const CvodeOptions& options, const Ivp& ivp, const StepControl& control,
               Work& work)
      : session_(formula, options, ivp, std::get<AdaptiveStep>(control), work) {}

  Status advance(double limit, double& t, VectorRef y) override { return session_.advance(limit, t, y); }
  void interpolate(double t, VectorRef out) override { session_.interpolate(t, out); }
  void restart(double t, ConstVectorRef y) override { session_.restart(t, y); }
  void collect_work(Work& work) const override { session_.collect_work(work); }

 private:
  CvodeSession session_;
};

/// The catalogue's entry of a formula with these options. Throws InputError where an option is out of range.
MethodInfo cvode_info(CvodeFormula formula, const CvodeOptions& options);

/// The iteration of a run.
CvodeIteration iteration_of(CvodeFormula formula, const CvodeOptions& options);

}  // namespace fw::oracles::detail
