#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>

#include "analysis/theory/scheme_growth.hpp"
#include "ode/integrator.hpp"

namespace fw::analysis {

/// How the largest stable step is looked for.
struct LimitSearch {
  double first = 0.0;        ///< the smallest step tried [s]
  double ratio = 1.25;       ///< of successive steps
  double farthest = 0.0;     ///< no larger step is tried [s]
  double resolution = 1e-3;  ///< relative, of the bisection
  /// Where the steps lie close, in case stability ends with a narrow gap there [s]: 2 % apart from 0.7 of it
  /// on and 0.25 % apart within 2 %. Infinite: nowhere.
  double watched = std::numeric_limits<double>::infinity();

  /// The step to be tried after this one.
  double next(double step) const;
};

/// The step up to which all are stable: the first unstable one on a geometric grid, then bisection. Infinite
/// where every step up to `farthest` is stable; 0 where none is, down to a 64th of the first.
double largest_stable_step(const std::function<bool(double step)>& is_stable, const LimitSearch& search);

/// Growth per step that counts: beyond what rounding and iterations leave of |R|, of roots of a polynomial, of
/// eigenvalues of small matrices that may be double, of single steps, or of the matrix of a whole step.
double resolved_growth(const SchemeGrowth& growth, bool is_of_whole_step, bool is_explicit);

/// The step [s] up to which a scheme multiplies no mode of the system by more than 1, in theory: infinite
/// where that holds up to `farthest` [s], 0 where an undamped mode grows at every step, NaN where theory has
/// no answer. `system` as for `SchemeGrowth::of_system`; `check` is called before every look and may throw.
double predicted_limit(const SchemeGrowth& growth, const LinearModes& modes,
                       const std::shared_ptr<const OdeSystem>& system, bool is_explicit, double first,
                       double farthest, const std::function<void()>& check = {});

/// Runs of a scheme from one perturbation, in a norm in which positions and velocities weigh alike.
class GrowthExperiment {
 public:
  /// The perturbation is drawn from `seed`: every moving degree of freedom between −1 and 1 in units of
  /// `amplitude`, velocities in units of amplitude·`frequency`. `stop` can end a run.
  GrowthExperiment(std::shared_ptr<const Integrator> integrator, std::shared_ptr<const OdeSystem> system,
                   double t0, double frequency, std::uint64_t seed, StopToken stop);

  /// From the vibration of one mode: its shape, its frequency ω, its energy as the norm. A scheme that treats
  /// every eigenvalue of J by itself multiplies that norm by |R(iωh)| in every step, to rounding.
  GrowthExperiment(std::shared_ptr<const Integrator> integrator, std::shared_ptr<const OdeSystem> system,
                   double t0, const Vector& shape, double frequency, StopToken stop);

  struct Outcome {
    /// Largest norm in the last quarter of the run over that in the first; infinite where a step fails or the
    /// norm exceeds 10²⁰ times its start.
    double growth = 0.0;
    /// ln of the factor per step, between the second and the fourth quarter; NaN where a step fails.
    double rate = 0.0;
    Status status{};  ///< why a step failed, or interrupted
  };
  Outcome run(double step, std::int64_t steps) const;

 private:
  std::shared_ptr<const Integrator> integrator_;
  std::shared_ptr<const OdeSystem> system_;
  double t0_;
  Vector start_, weight_;  ///< the norm is ‖weight·y‖
  StopToken stop_;
};

/// Whether a run on ẏ = λy, λ < 0, changes its sign within `steps` steps.
bool changes_sign(const Integrator& integrator, const std::shared_ptr<const OdeSystem>& system, double step,
                  std::int64_t steps);

}  // namespace fw::analysis
