#pragma once

#include <functional>

#include "constraints/distance_constraints.hpp"
#include "ode/integrator.hpp"

namespace fw::oracles {

struct ConstrainedOptions {
  /// The tolerances as IDA gets them, as a fraction of those given (decision 0017).
  double tolerance_factor = 1e-3;
  /// Moves an initial state off the constraints to the nearest one on them. Without it IDACalcIC answers such
  /// a state with its reason, since it changes multipliers and derivatives only.
  bool project_initial_state = false;
  /// Called at the start and after each step with the time and the multipliers λ [N]; may be empty.
  std::function<void(double t, ConstVectorRef lambda)> observe_multipliers{};
};

struct ConstrainedSolution {
  Solution solution;           ///< y = (q, v) and how the run ended
  Vector initial_multipliers;  ///< λ(t₀) [N] as IDACalcIC found it; empty where it failed
  Vector multipliers;          ///< λ at the time reached [N]
  /// Largest |g(q)| and |G(q) v| after any step: the drift off the constraints.
  double position_drift = 0.0;  ///< [m]
  double velocity_drift = 0.0;  ///< [m/s]
};

/// The motion of a second-order system with distance constraints, by IDA on the stabilised index-2 form of
/// Gear, Gupta and Leimkuhler [Gear, Gupta, Leimkuhler 1985; Brenan, Campbell, Petzold 1996]:
///   M q̇ = M v + Gᵀμ,   M v̇ = f(t, q, v) + Gᵀλ,   g(q) = 0,   G(q) v = 0
/// in the unknowns (q, v, μ, λ), where μ keeps positions on the constraints and vanishes in exact arithmetic.
/// λ and ẏ at the start come from IDACalcIC; the error test leaves μ and λ out. Newton's iteration with the
/// analytic sparse Jacobian and KLU.
///
/// Redundant constraints or a singular configuration at the start end in matrix_singular, every failure of
/// IDA in its own reason. InputError where the system is not of second order or `ivp` makes no sense.
ConstrainedSolution solve_constrained(const Ivp& ivp, const constraints::DistanceConstraints& constraints,
                                      const AdaptiveStep& control, const ConstrainedOptions& options,
                                      Observer& observer);

}  // namespace fw::oracles
