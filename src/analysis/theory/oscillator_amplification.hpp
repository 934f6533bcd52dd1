#pragma once

#include <functional>
#include <vector>

#include "analysis/theory/linear_scheme.hpp"
#include "core/types.hpp"

namespace fw::analysis {

/// The factors λ by which one step of a scheme multiplies the solutions of the oscillator q̈ = −ω²q, as a
/// function of z = ωh > 0: all of them, complex ones with their conjugates. A solution of the scheme is
/// q_n = Σ c_j λ_jⁿ.
using AmplificationFactors = std::function<std::vector<Complex>(double z)>;

/// The factors that follow from the coefficients: R(iz) of Runge–Kutta and Rosenbrock methods, the
/// eigenvalues of the 2×2 oscillator matrix of Nyström and splitting schemes, the roots of ρ(ζ) − iz σ(ζ) of
/// multistep formulas [Hairer, Wanner 1996, IV.3, V.1; Hairer, Lubich, Wanner 2006, I.5]. Empty where the
/// scheme is not given by coefficients, and of additive schemes, which need a splitting of the force.
AmplificationFactors amplification_factors(const schemes::SchemeData& data);

/// The eigenvalues of the 3×3 matrix by which Newmark's scheme and its relatives multiply (q, hv, h²a)
/// [Chung, Hulbert 1993].
AmplificationFactors amplification_factors(const integrators::AlphaParameters& parameters);

/// cos z ± i sin z: of schemes that are exact on linear oscillators.
AmplificationFactors exact_amplification_factors();

/// Those of the coefficients or of the rule; empty where neither says anything, and of Verlet's rules, whose
/// factors are those of velocity Verlet's coefficients.
AmplificationFactors amplification_factors(const LinearScheme& scheme);

/// What a scheme makes of an oscillation with z = ωh.
struct NumericalOscillation {
  Complex factor;                ///< the principal factor λ, which belongs to e^{iz}
  double phase = 0.0;            ///< θ = arg λ per step, continued from z = 0 [rad]
  double spectral_radius = 0.0;  ///< the largest |λ_j|
  /// The largest other factor in modulus over |λ|, conjugate aside; 0 where there is none.
  double parasitic_ratio = 0.0;
  /// Whether λ is complex, so that there is an oscillation.
  bool oscillates = false;

  /// ξ̄ = −ln|λ|/θ: the damping ratio of a damped oscillator that decays likewise; NaN without oscillation
  /// [Hughes 1987, 9.1]. Its logarithmic decrement per period is 2πξ̄.
  double damping_ratio() const;
  /// T̄/T − 1 = z/θ − 1, the relative error of the period; NaN without oscillation.
  double period_error(double z) const;
};

/// At each of the rising `z` > 0. The principal factor is followed in small steps from z = 0 on.
std::vector<NumericalOscillation> numerical_oscillations(const AmplificationFactors& factors,
                                                         const std::vector<double>& z);

/// The largest factor in modulus at z.
double spectral_radius(const AmplificationFactors& factors, double z);

/// lim z→∞ of the spectral radius; infinite where it grows without bound (explicit schemes).
double spectral_radius_at_infinity(const AmplificationFactors& factors);

}  // namespace fw::analysis
