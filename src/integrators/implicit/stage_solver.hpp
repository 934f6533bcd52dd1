#pragma once

#include <memory>

#include "core/work.hpp"
#include "linalg/simplified_newton.hpp"
#include "ode/ode_system.hpp"

namespace fw::integrators {

/// How the stage equations of implicit schemes are solved.
struct ImplicitOptions {
  /// Remaining error of Newton's iteration relative to the state. The default is the level of rounding, with
  /// constant steps as well as with chosen ones, so that the iteration never limits an order; see
  /// `SimplifiedNewton`.
  double newton_tolerance = 1e-15;
  /// A rate of convergence above this asks for a new matrix at the next stage; 0: a new one for each stage.
  double rate_of_renewal = 0.1;
};

/// Solves the stages of diagonally implicit schemes, k = f(t, ȳ + η k) with η = hγ, by simplified Newton
/// iterations.
///
/// A first-order system is solved for Y = ȳ + η k with the matrix I − ηJ, and k = (Y − ȳ)/η, which does not
/// magnify what the iteration has left [Hairer, Wanner 1996, IV.8]. A second-order system is reduced to its
/// velocities,
///   M (V − v̄) = η f(t, q̄ + η V, V),   matrix M − η D − η² K of half the size,
/// and then k = (V, M⁻¹f), V = v̄ + η M⁻¹f with the force evaluated last: momentum changes by forces only.
class StageSolver {
 public:
  virtual ~StageSolver() = default;

  /// k = f(t, y).
  virtual void slope(double t, ConstVectorRef y, VectorRef k) = 0;

  /// k holds the initial guess and receives the solution.
  virtual Status solve(double t, double eta, ConstVectorRef start, VectorRef k) = 0;

  /// e ← (I − ηJ)⁻¹ e with the matrix made last: a filter that keeps an error estimate from being governed by
  /// components that the scheme damps [Hairer, Wanner 1996, IV.8]. Leaves e where there is no matrix yet.
  virtual Status filter(double eta, VectorRef e) = 0;

  /// Forgets the matrix and its factors: the next solve works as the first one did.
  virtual void forget_matrix() = 0;
  /// Visits what the next solve and the next filter depend on.
  virtual void serialise(StateArchive& archive) = 0;
};

/// For the whole right-hand side.
std::unique_ptr<StageSolver> make_stage_solver(const OdeSystem& system, const ImplicitOptions& options,
                                               Work& work);
/// For (v, M⁻¹ f_stiff), the stiff part of a second-order system's right-hand side.
std::unique_ptr<StageSolver> make_stiff_stage_solver(const SecondOrderSystem& system,
                                                     const ForceSplitting& splitting,
                                                     const ImplicitOptions& options, Work& work);

}  // namespace fw::integrators
