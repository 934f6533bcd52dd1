#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "analysis/theory/linear_modes.hpp"
#include "analysis/theory/linear_scheme.hpp"
#include "ode/integrator.hpp"
#include "schemes/scheme_data.hpp"
#include "schemes/stability_function.hpp"

namespace fw::analysis {

class NystromStages;

/// Where the growth of a scheme is taken from.
enum class GrowthBasis {
  stability_function,         ///< R(z) of the coefficients
  characteristic_polynomial,  ///< ρ(ζ) − zσ(ζ) of a multistep formula
  oscillator_matrix,          ///< stages of a Nyström method or splitting on z̈ = −ω²z − cż
  two_step_recurrence,        ///< Verlet's x_{n+1} = P x_n + Q x_{n−1}
  amplification_matrix,       ///< of Newmark's scheme and its relatives on (z, hż, h²z̈)
  exponential,                ///< e^z of schemes that are exact on linear systems
  single_steps,  ///< the matrix of single steps of the running code: no prediction, since the runs that it
                 ///< is held against are made of the same steps
};

/// "R(z)", "characteristic polynomial", "oscillator matrix", "two-step recurrence",
/// "amplification matrix", "exp(z)", "single steps".
std::string_view to_string(GrowthBasis basis);

/// By how much a scheme multiplies the modes of a linear system in a step: the spectral radius of its step
/// [Hairer, Wanner 1996, IV.2 and V.1; Hairer, Lubich, Wanner 2006, VIII; van der Houwen, Sommeijer 1987].
class SchemeGrowth {
 public:
  /// Without coefficients and rule the growth is that of single steps of the code.
  SchemeGrowth(std::shared_ptr<const Integrator> integrator, const LinearScheme& scheme);
  SchemeGrowth(std::shared_ptr<const Integrator> integrator, const schemes::SchemeData& data)
      : SchemeGrowth(std::move(integrator), LinearScheme{data}) {}

  GrowthBasis basis() const { return basis_; }

  /// Of the mode λ at z = hλ. A scheme for M q̈ = f meets the pair λ, λ̄ as the oscillator with ω² = |λ|²,
  /// c = −2 Re λ (a real λ as the critically damped one). Infinite where a step fails, NaN where the scheme
  /// does not apply (forces f(t, q) only, and Re λ ≠ 0).
  double of_eigenvalue(Complex z) const;

  /// Of the vibration at a = h²ω², b = h c: both of its eigenvalues.
  double of_vibration(double a, double b) const;

  /// Of a step h on a linear system with these modes. Schemes that treat each eigenvalue of J by itself and
  /// systems with proportional damping need the modes only; else the matrix of the whole step is made from
  /// W and C, or by single steps on `system`. Without a system (null: a nonlinear one at some state) and
  /// where `modes` holds no W and C, damping is taken mode by mode.
  double of_system(const LinearModes& modes, double h, const std::shared_ptr<const OdeSystem>& system) const;

  /// Whether `of_system` comes from the eigenvalues of a matrix that may be defective, which are good to
  /// about the root of the rounding only.
  bool is_of_whole_step(const LinearModes& modes, const std::shared_ptr<const OdeSystem>& system) const;

  /// Whether it multiplies vibrations without damping by more than 1 at every step, however small: by the
  /// E-polynomial, the principal root in binary128, the determinant, or two small steps of the code.
  bool grows_at_every_step() const { return grows_at_every_step_; }

  /// Whether real eigenvalues have a factor with a sign, of which monotone decay could be told, and the
  /// factor: R(x), or one step of the code.
  std::optional<double> factor_of_decay(double x) const;

  const std::optional<schemes::StabilityFunction>& stability_function() const { return R_; }

 private:
  double of_single_steps_on_vibration(double a, double b) const;
  bool find_growth_at_every_step() const;
  bool is_by_eigenvalue() const;

  std::shared_ptr<const Integrator> integrator_;
  GrowthBasis basis_;
  LinearRule rule_;
  integrators::AlphaParameters alpha_;
  std::optional<schemes::StabilityFunction> R_;
  std::optional<schemes::MultistepFormula> formula_;
  std::optional<schemes::NystromValues<Float128>> nystrom_;
  std::shared_ptr<const NystromStages> stages_;
  bool grows_at_every_step_ = false;
};

}  // namespace fw::analysis
