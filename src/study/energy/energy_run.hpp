#pragma once

#include <memory>

#include "analysis/theory/oscillator_amplification.hpp"
#include "study/energy/energy_observer.hpp"

namespace fw::study {

/// One long run of a method at one step, and what its energy did.
struct EnergyRun {
  double step = 0.0;        ///< [s]
  std::uint64_t steps = 0;  ///< asked for
  Status status{};
  double end_time = 0.0;   ///< reached [s]
  bool is_energy = false;  ///< kinetic energy and potential, no other invariant
  std::unique_ptr<EnergyObserver> seen{};
  analysis::Drift drift{};  ///< of the energy's change
  /// Of an isolated spring or rotation: ln of the factor by which its amplitude grows per step,
  /// √(E_{n+1}/E_n) by least squares over all steps, and ln|λ(hω)| of theory; NaN where there is none.
  double growth = 0.0, predicted_growth = 0.0;
  /// How far the growth may be off: what is left of the oscillation in a slope over so many steps, and
  /// rounding.
  double growth_tolerance = 0.0;

  /// slope·duration over the size of the energy; NaN where it, or the change that is left at the end, is beyond
  /// 0.2: the energy is used up or multiplied, and no rate of drift describes it.
  double relative_drift() const;
  /// What rounding may do to the energy in so many steps [unit of the energy].
  double rounding() const;
  /// A trend that stands out of rounding and of its own interval, and has not used up the energy yet.
  bool has_clear_drift() const;
  /// 99 % of the energy have come from nowhere, so that it has grown a hundredfold (or the run has failed): bounds
  /// in proportion to it say nothing.
  bool has_blown_up() const;
};

/// What rounding may do to sums of numbers of size `magnitude` in n steps: a walk of a few units per step.
double energy_rounding(double magnitude, std::uint64_t steps);

/// What theory says of a method's energy.
struct EnergyTheory {
  analysis::AmplificationFactors factors;  ///< on a single oscillation
  analysis::ModifiedEnergyRule modified_energy = nullptr;
  bool has_coefficients = false;  ///< of the scheme that it is on forces f(q)
};

/// Runs `integrator` for `steps` steps. Throws `Interrupted`.
EnergyRun follow_energy(const WatchedProblem& watched, const Ivp& ivp, const Integrator& integrator,
                        const EnergyTheory& theory, double step, std::uint64_t steps, std::uint64_t bins,
                        const RunContext& context);

/// An exponent in h: by a power law with a 95 % interval from three steps on, from two steps the plain
/// quotient without one (NaN).
struct StepExponent {
  double value = 0.0, low = 0.0, high = 0.0;  ///< NaN where there is none
  int points = 0;
};
StepExponent exponent_in_step(const std::vector<double>& steps, const std::vector<double>& values);

/// The verdict on a case and the sentences it rests on.
struct EnergyVerdict {
  Verdict verdict = Verdict::not_applicable;
  std::string reason{};
};

/// What the exponents of the runs in h are.
struct EnergyExponents {
  StepExponent drift{}, oscillation{}, balance{};
};
EnergyExponents measure_exponents(const std::vector<EnergyRun>& runs);

/// Every statement of theory that applies to the method on the problem:
///  1. isolated spring or rotation: the amplitude grows by |λ(hω)| per step;
///  2. a modified energy in closed form is kept to rounding;
///  3. an energy-conserving scheme keeps the energy to its iteration tolerance;
///  4. a symplectic scheme has no secular drift: less than a tenth of the oscillation, or not significant at
///     5 % of all runs together; a trend refutes that where it would last: batches are long against the motion,
///     whose kinetic energy has no trend of its own, and the energy stays within a fifth of its size. Else it is
///     open;
///  5. any other scheme of order p drifts with h^p or a higher power;
///  6. energy lost and work of the dampers agree up to h^p or a higher power; 5 and 6 hold if the 95 % interval of
///     the exponent, from three steps or more, lies above p − 0.3, and fail if it lies below (unless forces have
///     kinks, and of 5 unless the motion has a trend of its own);
///  7. momenta of free systems: linear to rounding or iteration tolerance, angular likewise of symplectic
///     schemes that are given by coefficients (`keeps_angular_momentum`), since it is a quadratic invariant.
EnergyVerdict judge_energy(const WatchedProblem& watched, const MethodInfo& info, bool keeps_angular_momentum,
                           const std::vector<EnergyRun>& runs, const EnergyExponents& exponents);

}  // namespace fw::study
