#pragma once

#include <memory>
#include <optional>

#include "core/work.hpp"
#include "ode/step_control.hpp"
#include "oracles/sundials/arkode_tables.hpp"
#include "oracles/sundials/right_hand_part.hpp"
#include "oracles/sundials/run_report.hpp"

namespace fw::oracles::detail {

/// How accurately the stages of implicit tables are solved.
struct StageAccuracy {
  double newton_tolerance = 1e-14;   ///< with constant steps: of the state, relative
  double newton_coefficient = 0.01;  ///< with chosen steps: of the tolerances (ARKStepSetNonlinConvCoef)
};

/// ARKStep's memory for one run, with our functions as its parts; `ARKStepSetUserData` points to this object,
/// which therefore stays where it is. Report, work, vector and context outlive it.
class ArkStepMemory {
 public:
  /// A part is null where the tables have none for it. Newton's linear systems are solved by KLU.
  ArkStepMemory(double t0, N_Vector y0, std::unique_ptr<RightHandPart> explicit_part,
                std::unique_ptr<RightHandPart> implicit_part, const ArkodeTables& tables, RunReport& report,
                Work& work, SUNContext context);
  ArkStepMemory(const ArkStepMemory&) = delete;
  ArkStepMemory& operator=(const ArkStepMemory&) = delete;

  void* get() const { return memory_.get(); }

  /// Steps chosen by ARKODE from these tolerances; `absolute` are those of each component.
  void choose_steps(const AdaptiveStep& tolerances, Vector absolute, const StageAccuracy& accuracy);
  /// Constant steps (the caller sets them): stages are solved to rounding, `scale` being the size of the
  /// state.
  void take_constant_steps(double scale, const StageAccuracy& accuracy);

  /// With constant steps: where rounding keeps Newton's corrections above the tolerance of the stages (stiff
  /// forces), ten times the tolerance for the rest of the run, up to 1e-10; false where that was reached.
  bool raise_stage_tolerance();

  /// ARKStepReInit at (t, y): no history, a first step of ARKODE's choice. What ARKODE has counted goes to
  /// the work of the run before.
  void restart(double t, N_Vector y);

  long last_linear_flag() const;
  void collect_work(Work& work) const;

 private:
  /// ARKODE estimates the rate of Newton's iteration from all stages since the matrix was made, letting it
  /// fall by 0.3 per iteration. On forces that are almost linear the estimate becomes tiny, and where then
  /// the step changes by less than 20 % and the matrix stays, one correction that is far from converged
  /// passes: an error of 2e-5 in a single step at rtol = 1e-10 was measured on the harmonic oscillator. A new
  /// matrix sets the estimate back to 1.
  void renew_matrix_at_each_stage();
  static int explicit_function(sunrealtype t, N_Vector y, N_Vector dydt, void* self);
  static int implicit_function(sunrealtype t, N_Vector y, N_Vector dydt, void* self);
  static int jacobian_function(sunrealtype t, N_Vector y, N_Vector, SUNMatrix J, void* self, N_Vector,
                               N_Vector, N_Vector);
  int evaluate(RightHandPart& part, double t, N_Vector y, N_Vector dydt);

  Index size_;
  SUNContext context_;
  std::unique_ptr<RightHandPart> explicit_part_, implicit_part_;
  RunReport& report_;
  Work& work_;
  double stage_tolerance_ = 0.0, scale_ = 1.0;  ///< of constant steps
  std::optional<SparseDirectSolver> linear_solver_;
  ArkStepPointer memory_;
};

}  // namespace fw::oracles::detail
