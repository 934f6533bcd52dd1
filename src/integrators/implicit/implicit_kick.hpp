#pragma once

#include "core/status.hpp"
#include "core/work.hpp"
#include "linalg/conjugate_gradient.hpp"
#include "ode/second_order_system.hpp"

namespace fw::integrators {

/// Solves v = w + c M⁻¹ f(t, q, v) for v: the half-kick that keeps Verlet schemes at order 2 when forces
/// depend on velocity (erratum E6 of the lecture).
///
/// Newton's method; its matrix M − c D is never assembled: D·p comes from the system, M preconditions
/// conjugate gradients. Dampers are linear in v, so one correction suffices; obstacles may need a few. Where
/// forces depend on position only, v follows from one force without iteration.
class ImplicitKick {
 public:
  explicit ImplicitKick(const SecondOrderSystem& system, Work& work);

  /// `v` holds the initial guess and receives the solution; `force` receives f(t, q, v) at the solution, and
  /// v = w + c M⁻¹ force holds to rounding, so that momentum changes by the forces only.
  /// Fails with newton_failed or with the linear solver's Status.
  Status solve(double t, double c, ConstVectorRef q, ConstVectorRef w, VectorRef v, VectorRef force);

 private:
  const SecondOrderSystem& system_;
  Work& work_;
  Vector inverse_mass_, residual_, correction_, candidate_, zero_, product_, held_velocity_;
  linalg::ConjugateGradientWorkspace workspace_;
};

}  // namespace fw::integrators
