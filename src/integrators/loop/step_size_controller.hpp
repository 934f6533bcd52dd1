#pragma once

#include "core/state_archive.hpp"
#include "core/types.hpp"
#include "ode/ode_system.hpp"
#include "ode/step_control.hpp"

namespace fw::integrators {

/// How the next step follows from error estimates ε_n (in units of the tolerance) of the last steps:
///   h_{n+1} = h_n · safety · ε_n^{−β₁/k} ε_{n−1}^{−β₂/k} ε_{n−2}^{−β₃/k},  k = order of the error estimate
/// [Gustafsson 1991; Söderlind 2003; Hairer, Wanner 1996, IV.8].
enum class ControllerKind {
  integral,                          ///< I: β = (1, 0, 0)
  proportional_integral,             ///< PI: β = (0.7, −0.4, 0)
  proportional_integral_derivative,  ///< PID: the filter H312 of Söderlind, β = (1/4, 1/2, 1/4)
};

/// How the error vector becomes one number, with the scale sc_i = atol + rtol·max(|y_i|, |y'_i|).
enum class ErrorNorm {
  root_mean_square,  ///< √(Σ (e_i/sc_i)²/N): the motion of few among many counts little
  maximum,           ///< max |e_i|/sc_i
  largest_particle,  ///< `largest_particle_norm` on mass-spring systems, the root mean square on others
};

/// `root_mean_square` in place of `largest_particle` where the system is none of springs.
ErrorNorm norm_on(ErrorNorm norm, const OdeSystem& system);

struct ControllerOptions {
  ControllerKind kind = ControllerKind::proportional_integral;
  ErrorNorm norm = ErrorNorm::largest_particle;
  double safety = 0.9;
  double smallest_factor = 0.2;  ///< of one change of the step
  double largest_factor = 5.0;
};

/// The norm of the error in units of the tolerance: a step with a value ≤ 1 is accepted. `norm` is one that
/// `norm_on` has given; a tolerance of velocities that is not 0 is that of the second half of the state.
double error_in_tolerances(ErrorNorm norm, const AdaptiveStep& tolerances, ConstVectorRef error,
                           ConstVectorRef y, ConstVectorRef y_new);

/// The memory of a controller over a run.
class StepSizeController {
 public:
  /// `estimate_order` is k: the error estimate is O(h^k), k = min(p, p̂) + 1.
  StepSizeController(const ControllerOptions& options, int estimate_order);

  /// Factor of the step after an accepted step with error `error` (in tolerances).
  double after_acceptance(double error);
  /// Factor (< 1) of the step after a rejected one. A step that follows a rejection does not grow.
  double after_rejection(double error);

  /// Forgets the errors before.
  void restart();
  void serialise(StateArchive& archive);

 private:
  ControllerOptions options_;
  double exponent_;
  double previous_ = 1.0, before_previous_ = 1.0;
  bool rejected_ = false;
};

}  // namespace fw::integrators
