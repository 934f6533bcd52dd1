#pragma once

#include <functional>

#include "core/status.hpp"
#include "ode/integrator.hpp"

namespace fw::analysis {

/// How an oscillator is run and what of the run enters the fit.
struct OscillationRun {
  double periods = 10.0;  ///< of the exact oscillation in the window of the fit, which has at least 32 steps
  /// Steps before the window, in which parasitic factors die out; fewer where the amplitude leaves
  /// [1e-30, 1e30] before.
  int transient_steps = 400;
  StopToken stop{};  ///< can end the run
};

/// The principal factor of a scheme as a run of it shows it.
struct MeasuredOscillation {
  Status status{};       ///< of the run; the run may stop because the amplitude left the range of doubles
  Complex factor = 0.0;  ///< per step, Im ≥ 0
  double spectral_radius = 0.0;  ///< the larger |factor| of the pair
  double angle = 0.0;            ///< |arg| per step in [0, π] [rad]
  bool oscillates = false;       ///< the pair is complex
  double residual = 0.0;         ///< of the fit, relative to the amplitude
  int points = 0;                ///< in the fit; 0: the run left nothing to fit
};

/// Runs m q̈ = −k q, q(0) = 1, q̇(0) = ω/2 at h = z/ω and fits x_{n+2L} = s x_{n+L} − p x_n to the positions
/// and velocities of the window by least squares, each equation relative to its own amplitude. The factors
/// per step are the L-th roots of those of ζ² − sζ + p; with L steps to about a quarter of a period s and p
/// are well determined however small the step is. A window in which more than one pair of factors matters
/// shows in the residual. Throws InputError where the method cannot run on the system.
MeasuredOscillation measure_oscillation(const Integrator& integrator, double mass, double stiffness, double z,
                                        const OscillationRun& run);

/// The growth per step at a step so large that z = ωh counts as infinite: (‖y_2n‖/‖y_n‖)^{1/n} in the norm of
/// (q, hv), with n as large as the range of doubles allows, at most 1000. NaN where the run fails.
double measure_radius_at_infinity(const Integrator& integrator, double mass, double stiffness, double z,
                                  const OscillationRun& run);

}  // namespace fw::analysis
