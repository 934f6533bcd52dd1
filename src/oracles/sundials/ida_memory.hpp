#pragma once

#include "core/work.hpp"
#include "ode/step_control.hpp"
#include "oracles/sundials/arkode_objects.hpp"
#include "oracles/sundials/dae_form.hpp"
#include "oracles/sundials/run_report.hpp"

namespace fw::oracles::detail {

/// IDA's memory for one run on F(t, y, ẏ) = 0, steps chosen by tolerances, Newton's linear systems solved by
/// KLU. `IDASetUserData` points to this object, which therefore stays where it is.
class IdaMemory {
 public:
  IdaMemory(std::unique_ptr<DaeForm> form, double t0, double t1, const Vector& y0, const Vector& dydt0,
            const AdaptiveStep& tolerances, Work& work);
  IdaMemory(const IdaMemory&) = delete;
  IdaMemory& operator=(const IdaMemory&) = delete;

  void* get() const { return memory_.get(); }
  SUNContext context() const { return context_.get(); }
  DaeForm& form() { return *form_; }
  /// y and ẏ at the start, after `correct_initial_values` and after each step.
  const Vector& state() const { return state_; }
  const Vector& slope() const { return slope_; }

  /// Algebraic unknowns: `is_differential` is 1 for a differential one and 0 for an algebraic one, which the
  /// error test leaves out.
  void set_kinds(const Vector& is_differential);

  /// Tolerances of unknowns whose error counts by what it does in a step: entry i, of those above 0, has the
  /// absolute tolerance (that of the run)·`scale[i]`/h. To be called before the first step.
  void set_tolerances_per_step(const Vector& scale);

  /// IDACalcIC with IDA_YA_YDP_INIT: algebraic unknowns and ẏ of the differential ones, from y of the latter.
  Status correct_initial_values(double first_output);

  /// One step that does not pass `limit`.
  Status advance(double limit, double& t);

  /// IDAReInit at (t, y, ẏ): order 1, no history. What IDA has counted goes to the work of the run before.
  void restart(double t, ConstVectorRef y, ConstVectorRef dydt);

  void interpolate(double t, VectorRef out);
  void collect_work(Work& work) const;

 private:
  static int residual_function(sunrealtype t, N_Vector y, N_Vector dydt, N_Vector residual, void* self);
  static int jacobian_function(sunrealtype t, sunrealtype cj, N_Vector y, N_Vector, N_Vector, SUNMatrix J,
                               void* self, N_Vector, N_Vector, N_Vector);
  static int error_weights(N_Vector y, N_Vector weights, void* self);
  Status failure(int flag, double t) const;

  std::unique_ptr<DaeForm> form_;
  double start_, stop_time_, relative_tolerance_;
  Vector absolute_tolerances_;  ///< of each unknown
  Vector scale_per_step_;
  Work& work_;
  RunReport report_;
  StallCheck check_stall_;
  Vector state_, slope_, dense_, kinds_;
  ContextPointer context_;
  VectorPointer state_vector_, slope_vector_, dense_vector_, kinds_vector_;
  SparseDirectSolver linear_solver_;
  IdaPointer memory_;
};

}  // namespace fw::oracles::detail
