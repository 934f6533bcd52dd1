#include "analysis/theory/oscillator_amplification.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "core/special_values.hpp"
#include "schemes/linear_form.hpp"
#include "schemes/multistep_properties.hpp"

namespace fw::analysis {

namespace {

/// A factor counts as complex where its imaginary part is clear of the rounding of a double root.
constexpr double smallest_angle = 1e-6;

/// Roots of ζ² − sζ + p.
std::vector<Complex> quadratic_roots(double s, double p) {
  const double discriminant = 0.25 * s * s - p;
  if (discriminant < 0.0) {
    const double imaginary = std::sqrt(-discriminant);
    return {{0.5 * s, imaginary}, {0.5 * s, -imaginary}};
  }
  const double larger = 0.5 * s + std::copysign(std::sqrt(discriminant), s);
  return {larger, larger == 0.0 ? 0.0 : p / larger};
}

AmplificationFactors of_stability_function(schemes::StabilityFunction R) {
  return [R = std::move(R)](double z) -> std::vector<Complex> {
    const Complex factor = R(Complex(0.0, z));
    return {factor, std::conj(factor)};
  };
}

AmplificationFactors of_nystrom(const schemes::NystromValues<Float128>& t) {
  const Index s = t.stages;
  Matrix A(s, s), stage(s, 2), out(2, s);
  for (Index i = 0; i < s; ++i) {
    const auto k = static_cast<std::size_t>(i);
    for (Index j = 0; j < s; ++j) {
      A(i, j) =
          static_cast<double>(t.a_position[k * static_cast<std::size_t>(s) + static_cast<std::size_t>(j)]);
    }
    stage.row(i) << 1.0, static_cast<double>(t.c[k]);
    out.col(i) << static_cast<double>(t.b_position[k]), static_cast<double>(t.b_velocity[k]);
  }
  return [A, stage, out](double z) {
    // k_i = −z² (q + c_i hv + Σ_j ā_ij k_j) in units of h⁻².
    const Matrix system = Matrix::Identity(A.rows(), A.cols()) + z * z * A;
    Eigen::Matrix2d m = -z * z * (out * system.partialPivLu().solve(stage));
    m(0, 0) += 1.0;
    m(0, 1) += 1.0;
    m(1, 1) += 1.0;
    return quadratic_roots(m.trace(), m.determinant());
  };
}

struct FactorsOf {
  AmplificationFactors operator()(std::monostate) const { return {}; }
  AmplificationFactors operator()(const schemes::StabilityFunction& R) const {
    return of_stability_function(R);
  }
  AmplificationFactors operator()(const schemes::NystromValues<Float128>& values) const {
    return of_nystrom(values);
  }
  AmplificationFactors operator()(const schemes::MultistepFormula& formula) const {
    return [formula](double z) {
      std::vector<Complex> roots = schemes::characteristic_roots(formula, Complex(0.0, z));
      const std::size_t count = roots.size();
      for (std::size_t k = 0; k < count; ++k) roots.push_back(std::conj(roots[k]));
      return roots;
    };
  }
};

/// The index of the factor nearest to `target`.
std::size_t nearest(const std::vector<Complex>& factors, Complex target) {
  const auto closer = [target](Complex a, Complex b) { return std::abs(a - target) < std::abs(b - target); };
  return static_cast<std::size_t>(std::min_element(factors.begin(), factors.end(), closer) - factors.begin());
}

/// Follows the principal factor as z grows.
class PrincipalFactor {
 public:
  explicit PrincipalFactor(const AmplificationFactors& factors) : factors_(factors) {}

  NumericalOscillation advance_to(double z) {
    while (z_ < z) step(std::min(z, z_ + spacing()));
    NumericalOscillation result;
    result.factor = factor_;
    result.phase = phase_;
    const std::vector<Complex> all = factors_(z);
    const double size = std::abs(factor_);
    result.oscillates = std::abs(factor_.imag()) > smallest_angle * size;
    const std::size_t principal = nearest(all, factor_);
    const std::size_t conjugate = result.oscillates ? nearest(all, std::conj(factor_)) : principal;
    for (std::size_t k = 0; k < all.size(); ++k) {
      result.spectral_radius = std::max(result.spectral_radius, std::abs(all[k]));
      if (k == principal || k == conjugate || size == 0.0) continue;
      result.parasitic_ratio = std::max(result.parasitic_ratio, std::abs(all[k]) / size);
    }
    return result;
  }

 private:
  /// Fine near the start, where all factors of a multistep formula may lie close together.
  double spacing() const { return std::clamp(0.05 * z_, 1e-3, 0.02); }

  void step(double z) {
    const Complex target =
        z_ == 0.0 ? std::polar(1.0, z) : factor_ + (factor_ - before_) * ((z - z_) / width_);
    const std::vector<Complex> all = factors_(z);
    const Complex next = all[nearest(all, target)];
    if (next != Complex(0.0) && factor_ != Complex(0.0)) phase_ += std::arg(next / factor_);
    before_ = factor_;
    factor_ = next;
    width_ = z - z_;
    z_ = z;
  }

  const AmplificationFactors& factors_;
  double z_ = 0.0, phase_ = 0.0, width_ = 1.0;
  Complex factor_ = 1.0, before_ = 1.0;
};

}  // namespace

AmplificationFactors amplification_factors(const schemes::SchemeData& data) {
  return std::visit(FactorsOf{}, schemes::linear_form(data));
}

AmplificationFactors amplification_factors(const integrators::AlphaParameters& parameters) {
  return [p = parameters](double z) {
    // Unknowns (q', hv', h²a') over (q, hv, h²a); the third row is (1 − α_m) a' + α_m a = −z² (…).
    Eigen::Matrix3d left, right;
    left << 1.0, 0.0, -p.beta, 0.0, 1.0, -p.gamma, (1.0 - p.alpha_f) * z * z, 0.0, 1.0 - p.alpha_m;
    right << 1.0, 1.0, 0.5 - p.beta, 0.0, 1.0, 1.0 - p.gamma, -p.alpha_f * z * z, 0.0, -p.alpha_m;
    const Eigen::Vector3cd values =
        Eigen::EigenSolver<Eigen::Matrix3d>(left.partialPivLu().solve(right), false).eigenvalues();
    return std::vector<Complex>(values.data(), values.data() + values.size());
  };
}

AmplificationFactors exact_amplification_factors() {
  return [](double z) { return std::vector<Complex>{std::polar(1.0, z), std::polar(1.0, -z)}; };
}

AmplificationFactors amplification_factors(const LinearScheme& scheme) {
  switch (scheme.rule) {
    case LinearRule::of_coefficients:
      return amplification_factors(scheme.data);
    case LinearRule::exact:
      return exact_amplification_factors();
    case LinearRule::alpha_family:
      return amplification_factors(scheme.alpha);
    case LinearRule::verlet_central_velocity:
    case LinearRule::verlet_backward_velocity:
      break;
  }
  return {};
}

double NumericalOscillation::damping_ratio() const {
  return oscillates ? 0.0 - std::log(std::abs(factor)) / phase : no_value;
}

double NumericalOscillation::period_error(double z) const {
  return oscillates ? z / phase - 1.0 : no_value;
}

std::vector<NumericalOscillation> numerical_oscillations(const AmplificationFactors& factors,
                                                         const std::vector<double>& z) {
  PrincipalFactor principal(factors);
  std::vector<NumericalOscillation> results;
  for (const double value : z) results.push_back(principal.advance_to(value));
  return results;
}

double spectral_radius(const AmplificationFactors& factors, double z) {
  double largest = 0.0;
  for (const Complex factor : factors(z)) largest = std::max(largest, std::abs(factor));
  return largest;
}

double spectral_radius_at_infinity(const AmplificationFactors& factors) {
  const double far = spectral_radius(factors, 1e5), farther = spectral_radius(factors, 1e6);
  // What grows, grows at least like z (a splitting of order 1 like z²).
  if (!(farther < 3.0 * far + 1.0)) return std::numeric_limits<double>::infinity();
  // What vanishes, falls like z^{−1/k} of a k-step formula at least; k ≤ 6.
  return farther < 0.75 * far ? 0.0 : farther;
}

}  // namespace fw::analysis
