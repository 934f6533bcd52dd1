#pragma once

#include <functional>
#include <memory>
#include <string>

#include "oracles/foreign_stepper.hpp"
#include "oracles/petsc/ts_equations.hpp"

namespace fw::oracles {

/// What makes one method out of TS.
struct TsMethod {
  std::string type;                     ///< TSType
  TsForm form = TsForm::explicit_form;  ///< of the equations
  std::function<void(TS)> configure{};  ///< sets what belongs to the type
  int order = 1;                        ///< for the first step
  std::string petsc_options{};          ///< of the user, in PETSc's notation
};

/// A run of PETSc's TS: one TSStep per call. Newton's iteration with PETSc's full steps, linear systems by
/// KLU unless the user's options say otherwise.
class TsStepper final : public ForeignStepper {
 public:
  /// Throws InputError for options that PETSc does not take.
  TsStepper(const TsMethod& method, const Ivp& ivp, const StepControl& control, Work& work);

  Status advance(double limit, double& t, VectorRef y) override;
  /// TSInterpolate: of TSBDF of the order of the step, of other types of lower orders, which differ.
  void interpolate(double t, VectorRef out) override;
  /// A new TS: what each type of it keeps from step to step is its own affair.
  void restart(double t, ConstVectorRef y) override;
  void collect_work(Work& work) const override;

 private:
  void create();
  void configure(const TsMethod& method);
  void set_solver_defaults();
  Status failure(TSConvergedReason reason, double t);

  std::string name_;
  bool is_implicit_;
  bool is_adaptive_;
  bool is_first_ = true;
  bool has_monitor_;
  double t_;
  TsMethod method_;
  Ivp ivp_;  ///< from the last start
  StepControl control_;
  Work& work_;
  linalg::PetscOptionText text_;
  std::unique_ptr<TsEquations> equations_;
  linalg::PetscTs stepper_;
};

}  // namespace fw::oracles
