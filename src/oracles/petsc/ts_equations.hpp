#pragma once

#include <exception>
#include <memory>
#include <optional>

#include "core/work.hpp"
#include "linalg/petsc_matrix.hpp"
#include "ode/first_order_jacobian.hpp"
#include "ode/ivp.hpp"
#include "ode/pattern_watch.hpp"

namespace fw::oracles {

/// The form in which PETSc's TS gets ẏ = f(t, y).
enum class TsForm {
  explicit_form,      ///< ẏ = f(t, y)
  implicit_form,      ///< F = ẏ − f(t, y) = 0 with ∂F/∂y + σ ∂F/∂ẏ = σI − J
  implicit_explicit,  ///< F = ẏ − (v, M⁻¹ f_stiff) = (0, M⁻¹ f_soft)
  autonomous,         ///< the implicit form of y and t together, for schemes made for ẏ = f(y)
  second_order,       ///< F = M a − f(t, q, v) = 0 with −K − σ_v D + σ_a M
  hamiltonian,        ///< "position": q̇ = v, "momentum": v̇ = M⁻¹ f(t, q), as two parts
};

/// Our system as PETSc's callbacks. No exception passes through PETSc: it is kept, PETSc gets an error code.
class TsEquations {
 public:
  TsEquations(const Ivp& ivp, TsForm form, Work& work);

  /// Hands functions, matrices and the initial state to `stepper`, which keeps pointers to this object.
  void attach(TS stepper);

  /// y as the stepper has it.
  void copy_state(VectorRef y) const;
  /// Writes what TS interpolates at time t into y; not of the form `second_order`.
  void interpolate(TS ts, double t, VectorRef y);

  /// Throws what a callback has thrown since the last time.
  void rethrow();
  /// Whether a function has given values that are not finite since the last time.
  bool take_non_finite();

 private:
  static PetscErrorCode explicit_slope(TS, PetscReal, Vec, Vec, void*);
  static PetscErrorCode soft_slope(TS, PetscReal, Vec, Vec, void*);
  static PetscErrorCode implicit_residual(TS, PetscReal, Vec, Vec, Vec, void*);
  static PetscErrorCode implicit_matrix(TS, PetscReal, Vec, Vec, PetscReal, Mat, Mat, void*);
  static PetscErrorCode second_order_residual(TS, PetscReal, Vec, Vec, Vec, Vec, void*);
  static PetscErrorCode second_order_matrix(TS, PetscReal, Vec, Vec, Vec, PetscReal, PetscReal, Mat, Mat,
                                            void*);
  static PetscErrorCode velocity_of_position(TS, PetscReal, Vec, Vec, void*);
  static PetscErrorCode force_on_momentum(TS, PetscReal, Vec, Vec, void*);
  static PetscErrorCode state_is_finite(TS, PetscReal, Vec, PetscBool*);

  std::uint64_t revision() const;
  /// Patterns of the matrices and the places of their entries.
  void make_patterns();
  /// Makes them anew, and PETSc's matrix with them, where the system has changed its pattern.
  void renew_patterns();
  /// f(t, y), or its stiff part.
  void slope(double t, ConstVectorRef y, VectorRef dydt);
  /// σI − J into `matrix_`.
  void assemble(double t, ConstVectorRef y, double sigma);
  void assemble_stiff(double t, ConstVectorRef y);
  void differentiate_in_time(double t, ConstVectorRef y);
  void note(ConstVectorRef values);
  template <class Body>
  PetscErrorCode guarded(Body body);

  const OdeSystem& system_;
  const SecondOrderSystem* second_order_;
  TsForm form_;
  Work& work_;
  double t0_, length_;
  Vector y0_;
  PatternWatch watch_;
  std::optional<FirstOrderJacobian> blocks_;  ///< implicit–explicit form
  SparseMatrix jacobian_, stiffness_, damping_, matrix_;
  std::vector<int> jacobian_place_;  ///< of each entry of the Jacobian in `matrix_`
  std::vector<int> diagonal_place_;
  std::vector<int> time_place_;  ///< of the column ∂/∂t in `matrix_`, autonomous form
  std::unique_ptr<linalg::PetscMatrix> petsc_matrix_;
  linalg::PetscVec state_, velocity_;
  linalg::PetscVec inside_;  ///< of a step; made when it is first asked for
  linalg::PetscIndexSet positions_, momenta_;
  Vector time_derivative_, other_slope_, shifted_;
  std::exception_ptr exception_;
  bool non_finite_ = false, stage_is_non_finite_ = false;
};

}  // namespace fw::oracles
