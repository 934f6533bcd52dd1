#pragma once

#include "integrators/loop/stepper.hpp"

namespace fw::integrators {

/// The family of structural dynamics' one-step schemes on M q̈ = f(t, q, v), which keep an acceleration a
/// beside (q, v):
///   q' = q + h v + h² ((½ − β) a + β a'),   v' = v + h ((1 − γ) a + γ a'),
///   M ((1 − α_m) a' + α_m a) = (1 − α_f) f(t + h, q', v') + α_f f(t, q, v)
/// [Newmark 1959; Hilber, Hughes, Taylor 1977; Chung, Hulbert 1993]. The force is weighted, not its
/// arguments, so that a step needs the force at its ends only. a₀ = M⁻¹f(t₀, q₀, v₀).
struct AlphaParameters {
  double alpha_m = 0.0;
  double alpha_f = 0.0;
  double beta = 0.25;
  double gamma = 0.5;

  /// 2 where γ = ½ − α_m + α_f, else 1.
  int order() const;
  /// Unconditional stability on linear systems: α_m ≤ α_f ≤ ½ and β ≥ ¼ + ½ (α_f − α_m), and no negative
  /// numerical damping (γ ≥ ½ − α_m + α_f) [Chung, Hulbert 1993].
  bool is_unconditionally_stable() const;
};

/// The stepper of the family: the nonlinear equation for a' by Newton's iteration to convergence (see
/// `ImplicitAcceleration`). Newmark's scheme with β = 0 is explicit where forces depend on position only.
StepperFactory alpha_family_stepper(const AlphaParameters& parameters);

}  // namespace fw::integrators
