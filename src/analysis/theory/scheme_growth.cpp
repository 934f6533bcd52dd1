#include "analysis/theory/scheme_growth.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "analysis/theory/growth_matrices.hpp"
#include "analysis/theory/single_steps.hpp"
#include "core/special_values.hpp"
#include "schemes/derived_properties.hpp"
#include "schemes/linear_form.hpp"
#include "schemes/multistep_properties.hpp"

namespace fw::analysis {

namespace {

using WideComplex = std::complex<Float128>;

/// |ζ|² − 1 of the principal root of ρ(ζ) = iy σ(ζ), in binary128.
Float128 principal_excess(const schemes::MultistepFormula& formula, double y) {
  const WideComplex mu(0, y);
  WideComplex zeta(cos(Float128(y)), sin(Float128(y)));
  constexpr int newton_steps = 12;
  for (int k = 0; k < newton_steps; ++k) {
    WideComplex value(0), slope(0);
    for (std::size_t j = formula.alpha.size(); j-- > 0;) {
      slope = slope * zeta + value;
      value =
          value * zeta + WideComplex(formula.alpha[j].value()) - mu * WideComplex(formula.beta[j].value());
    }
    zeta -= value / slope;
  }
  return zeta.real() * zeta.real() + zeta.imag() * zeta.imag() - 1;
}

}  // namespace

std::string_view to_string(GrowthBasis basis) {
  switch (basis) {
    case GrowthBasis::stability_function:
      return "R(z)";
    case GrowthBasis::characteristic_polynomial:
      return "characteristic polynomial";
    case GrowthBasis::oscillator_matrix:
      return "oscillator matrix";
    case GrowthBasis::two_step_recurrence:
      return "two-step recurrence";
    case GrowthBasis::amplification_matrix:
      return "amplification matrix";
    case GrowthBasis::exponential:
      return "exp(z)";
    case GrowthBasis::single_steps:
      return "single steps";
  }
  return "";
}

SchemeGrowth::SchemeGrowth(std::shared_ptr<const Integrator> integrator, const LinearScheme& scheme)
    : integrator_(std::move(integrator)),
      basis_(GrowthBasis::single_steps),
      rule_(scheme.rule),
      alpha_(scheme.alpha) {
  schemes::LinearForm form = schemes::linear_form(scheme.data);
  if (auto* R = std::get_if<schemes::StabilityFunction>(&form)) {
    basis_ = GrowthBasis::stability_function;
    R_ = std::move(*R);
  } else if (const auto* formula = std::get_if<schemes::MultistepFormula>(&form)) {
    basis_ = GrowthBasis::characteristic_polynomial;
    formula_ = *formula;
  } else if (auto* nystrom = std::get_if<schemes::NystromValues<Float128>>(&form)) {
    basis_ = GrowthBasis::oscillator_matrix;
    stages_ = std::make_shared<const NystromStages>(*nystrom);
    nystrom_ = std::move(*nystrom);
  } else if (rule_ == LinearRule::exact) {
    basis_ = GrowthBasis::exponential;
  } else if (rule_ == LinearRule::alpha_family) {
    basis_ = GrowthBasis::amplification_matrix;
  } else if (rule_ != LinearRule::of_coefficients) {
    basis_ = GrowthBasis::two_step_recurrence;
  }
  grows_at_every_step_ = find_growth_at_every_step();
}

/// An interval on the imaginary axis that is shorter is what rounding of coefficients leaves of none: with
/// 16-digit coefficients |R(iy)|² − 1 ~ C y^{2k} is lost below.
constexpr double shortest_interval = 0.01;

bool SchemeGrowth::find_growth_at_every_step() const {
  switch (basis_) {
    case GrowthBasis::stability_function:
      return schemes::linear_stability(*R_).imaginary_interval < shortest_interval;
    case GrowthBasis::characteristic_polynomial: {
      constexpr double above_rounding = 1e-27;
      return principal_excess(*formula_, 0.01) > above_rounding &&
             principal_excess(*formula_, 0.02) > above_rounding;
    }
    case GrowthBasis::oscillator_matrix:
      return schemes::oscillator_stability(*nystrom_).interval < shortest_interval;
    case GrowthBasis::two_step_recurrence:  // Verlet's without damping, stable up to ωh = 2
    case GrowthBasis::exponential:
      return false;
    case GrowthBasis::amplification_matrix:
      return of_vibration(1e-4, 0.0) > 1.0;
    case GrowthBasis::single_steps: {
      const double coarse = of_vibration(0.04, 0.0) - 1.0, fine = of_vibration(0.01, 0.0) - 1.0;
      // Growth that vanishes with a power of the step, not what a solver leaves of its equations.
      return coarse > 1e-9 && fine > 1e-14 && coarse > 4.0 * fine;
    }
  }
  return false;
}

double SchemeGrowth::of_eigenvalue(Complex z) const {
  switch (basis_) {
    case GrowthBasis::stability_function:
      return std::abs((*R_)(z));
    case GrowthBasis::characteristic_polynomial:
      return schemes::amplification(*formula_, z.real(), z.imag());
    case GrowthBasis::exponential:
      // Of a scheme for forces f(t, q), nothing is said where there is damping.
      if (integrator_->info().needs.has(Capability::position_forces) && z.real() != 0.0) return no_value;
      return std::exp(z.real());
    case GrowthBasis::oscillator_matrix:
    case GrowthBasis::two_step_recurrence:
    case GrowthBasis::amplification_matrix:
      break;
    case GrowthBasis::single_steps:
      if (integrator_->info().needs.has(Capability::second_order) || carries_more(integrator_->info())) break;
      return growth_of_steps(*integrator_, planar_flow(z), 1.0);
  }
  return of_vibration(std::norm(z), -2.0 * z.real());
}

double SchemeGrowth::of_vibration(double a, double b) const {
  switch (basis_) {
    case GrowthBasis::stability_function:
    case GrowthBasis::characteristic_polynomial:
    case GrowthBasis::exponential: {
      const Complex root = std::sqrt(Complex(0.25 * b * b - a));
      return std::max(of_eigenvalue(-0.5 * b + root), of_eigenvalue(-0.5 * b - root));
    }
    case GrowthBasis::oscillator_matrix:
      if (b != 0.0 && !stages_->has_velocity()) return no_value;
      return spectral_radius(stages_->of_vibration(a, b));
    case GrowthBasis::two_step_recurrence:
      return spectral_radius(
          Eigen::Matrix2d(verlet_recurrence(rule_, Matrix::Constant(1, 1, a), Matrix::Constant(1, 1, b))));
    case GrowthBasis::amplification_matrix:
      return alpha_growth(alpha_, a, b);
    case GrowthBasis::single_steps:
      break;
  }
  return of_single_steps_on_vibration(a, b);
}

double SchemeGrowth::of_single_steps_on_vibration(double a, double b) const {
  const std::shared_ptr<const OdeSystem> system = vibration(a, b);
  if (!why_not_applicable(integrator_->info(), *system).empty()) return no_value;
  return growth_of_steps(*integrator_, system, 1.0);
}

bool SchemeGrowth::is_of_whole_step(const LinearModes& modes,
                                    const std::shared_ptr<const OdeSystem>& system) const {
  switch (basis_) {
    case GrowthBasis::stability_function:
    case GrowthBasis::characteristic_polynomial:
    case GrowthBasis::exponential:
      return false;
    case GrowthBasis::oscillator_matrix:
    case GrowthBasis::two_step_recurrence:
    case GrowthBasis::amplification_matrix:
      return system != nullptr && modes.coupling > 0.0 && modes.stiffness.size() > 0;
    case GrowthBasis::single_steps:
      return system != nullptr && (integrator_->info().needs.has(Capability::force_splitting) ||
                                   modes.coupling > 0.0 || modes.vibrations.empty() || !modes.is_complete);
  }
  return false;
}

bool SchemeGrowth::is_by_eigenvalue() const {
  return basis_ == GrowthBasis::stability_function || basis_ == GrowthBasis::characteristic_polynomial ||
         basis_ == GrowthBasis::exponential;
}

double SchemeGrowth::of_system(const LinearModes& modes, double h,
                               const std::shared_ptr<const OdeSystem>& system) const {
  if (is_of_whole_step(modes, system)) {
    if (basis_ == GrowthBasis::single_steps) return growth_of_steps(*integrator_, system, h);
    if (basis_ == GrowthBasis::two_step_recurrence)
      return spectral_radius(verlet_recurrence(rule_, h * h * modes.stiffness, h * modes.damping));
    if (basis_ == GrowthBasis::amplification_matrix)
      return spectral_radius(alpha_step_matrix(alpha_, h * h * modes.stiffness, h * modes.damping));
    if (!stages_->has_velocity()) return no_value;
    return spectral_radius(stages_->of_system(modes.stiffness, modes.damping, h));
  }
  double largest = 0.0;
  const bool by_eigenvalue = is_by_eigenvalue() || modes.vibrations.empty();
  const auto consider = [&](double growth) {
    largest = std::isnan(growth) || std::isnan(largest) ? no_value : std::max(largest, growth);
  };
  if (by_eigenvalue) {
    for (const Complex& lambda : modes.eigenvalues) {
      if (lambda.imag() >= 0.0) consider(of_eigenvalue(h * lambda));
    }
  } else {
    for (const VibrationMode& mode : modes.vibrations)
      consider(of_vibration(h * h * mode.omega_squared, h * mode.damping));
  }
  return largest;
}

std::optional<double> SchemeGrowth::factor_of_decay(double x) const {
  if (basis_ == GrowthBasis::stability_function) return (*R_)({x, 0.0}).real();
  if (basis_ == GrowthBasis::exponential && !integrator_->info().needs.has(Capability::second_order))
    return std::exp(x);
  if (basis_ != GrowthBasis::single_steps || integrator_->info().needs.has(Capability::second_order) ||
      carries_more(integrator_->info())) {
    return std::nullopt;
  }
  const std::vector<Vector> states = states_after(*integrator_, decay(x), 1.0, 1, Vector::Ones(1));
  return states.empty() ? std::nullopt : std::optional(states.back()[0]);
}

}  // namespace fw::analysis
