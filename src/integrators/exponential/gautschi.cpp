#include "integrators/exponential/gautschi.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "dense/eigenvalues.hpp"
#include "integrators/loop/stepper.hpp"
#include "ode/not_applicable.hpp"

namespace fw::integrators {

namespace {

double sinc(double x) {
  return x == 0.0 ? 1.0 : std::sin(x) / x;
}

/// The matrix functions of a step as factors of the eigenvectors.
struct Factors {
  Vector cosine{}, sine_over_frequency{}, frequency_times_sine{}, psi{}, psi0{}, psi1{}, phi{};
};

Factors make_factors(TrigonometricFilter filter, double h, const Vector& frequency) {
  const Index n = frequency.size();
  Factors factors{Vector(n), Vector(n), Vector(n), Vector(n), Vector(n), Vector(n), Vector(n)};
  for (Index i = 0; i < n; ++i) {
    const double x = h * frequency[i];
    const double s = sinc(x);
    const double c = std::cos(x);
    factors.cosine[i] = c;
    factors.sine_over_frequency[i] = h * s;
    factors.frequency_times_sine[i] = frequency[i] * std::sin(x);
    switch (filter) {
      case TrigonometricFilter::gautschi:
        factors.psi[i] = sinc(0.5 * x) * sinc(0.5 * x);
        factors.psi0[i] = factors.psi1[i] = s;
        factors.phi[i] = 1.0;
        break;
      case TrigonometricFilter::deuflhard:
        factors.psi[i] = s;
        factors.psi0[i] = c;
        factors.psi1[i] = 1.0;
        factors.phi[i] = 1.0;
        break;
      case TrigonometricFilter::mollified_impulse:
        factors.psi[i] = s * s;
        factors.psi0[i] = c * s;
        factors.psi1[i] = s;
        factors.phi[i] = s;
        break;
    }
  }
  return factors;
}

/// Works in the coordinates z = Qᵀ M^{1/2} (q − q₀) of the eigenvectors Q, for the moving degrees of freedom.
class GautschiStepper final : public Stepper {
 public:
  GautschiStepper(TrigonometricFilter filter, const Ivp& ivp, Work& work)
      : filter_(filter),
        system_(*ivp.system->second_order()),
        work_(work),
        start_(system_.degrees_of_freedom()),
        velocity_(Vector::Zero(start_.size())),
        force_(start_.size()) {
    for (Index i = 0; i < start_.size(); ++i) {
      if (!system_.fixed()[static_cast<std::size_t>(i)]) moving_.push_back(i);
    }
    const auto n = static_cast<Index>(moving_.size());
    if (n > largest_gautschi_size) {
      throw NotApplicable(
          fmt::format("method \"gautschi\" makes dense matrix functions: found {} moving degrees of "
                      "freedom, expected at most {}",
                      n, largest_gautschi_size));
    }
    for (Vector* vector : {&z_, &dz_, &new_z_, &new_dz_, &filtered_, &rest_, &new_rest_, &physical_})
      *vector = Vector::Zero(n);
    restart(ivp.t0, ivp.y0);
  }

  Status step(double t, double h, VectorRef y) override {
    if (h != factors_step_) {
      factors_ = make_factors(filter_, h, frequency_);
      factors_step_ = h;
      evaluate_rest(t, z_, rest_);
    }
    new_z_ = factors_.cosine.cwiseProduct(z_) + factors_.sine_over_frequency.cwiseProduct(dz_) +
             (0.5 * h * h) * factors_.psi.cwiseProduct(rest_);
    evaluate_rest(t + h, new_z_, new_rest_);
    new_dz_ = factors_.cosine.cwiseProduct(dz_) - factors_.frequency_times_sine.cwiseProduct(z_) +
              (0.5 * h) * (factors_.psi0.cwiseProduct(rest_) + factors_.psi1.cwiseProduct(new_rest_));
    z_.swap(new_z_);
    dz_.swap(new_dz_);
    rest_.swap(new_rest_);

    const Index size = start_.size();
    physical_.noalias() = vectors_ * z_;
    for (std::size_t k = 0; k < moving_.size(); ++k) {
      const auto i = static_cast<Index>(k);
      y[moving_[k]] = start_[moving_[k]] + physical_[i] * inverse_root_mass_[i];
    }
    physical_.noalias() = vectors_ * dz_;
    for (std::size_t k = 0; k < moving_.size(); ++k) {
      const auto i = static_cast<Index>(k);
      y[size + moving_[k]] = physical_[i] * inverse_root_mass_[i];
    }
    return {};
  }

  /// The modes are those of the tangent stiffness at the state.
  void restart(double t, ConstVectorRef y) override {
    start_ = y.head(start_.size());
    position_ = start_;
    decompose(t);
    coordinates(y);
    factors_step_ = 0.0;
  }
  void serialise(StateArchive& archive) override {
    archive.visit("origin", start_);
    archive.visit("eigenvectors", vectors_);
    archive.visit("frequencies", frequency_);
    archive.visit("coordinates", z_);
    archive.visit("velocities", dz_);
    archive.visit("rest of the force", rest_);
    archive.visit("step of the factors", factors_step_);
    if (!archive.is_loading()) return;
    position_ = start_;
    if (factors_step_ != 0.0) factors_ = make_factors(filter_, factors_step_, frequency_);
  }

 private:
  void decompose(double t) {
    SparseMatrix stiffness = system_.tangent_pattern();
    system_.stiffness(t, start_, velocity_, TangentModel::exact, stiffness);
    ++work_.jacobian_evaluations;
    ++work_.factorisations;
    const auto n = static_cast<Index>(moving_.size());
    inverse_root_mass_.resize(n);
    for (Index i = 0; i < n; ++i) {
      inverse_root_mass_[i] = 1.0 / std::sqrt(system_.mass()[moving_[static_cast<std::size_t>(i)]]);
    }
    Matrix A(n, n);
    for (Index j = 0; j < n; ++j) {
      for (Index i = 0; i < n; ++i) {
        const double k =
            stiffness.coeff(moving_[static_cast<std::size_t>(i)], moving_[static_cast<std::size_t>(j)]);
        A(i, j) = -k * inverse_root_mass_[i] * inverse_root_mass_[j];
      }
    }
    const Matrix symmetric = 0.5 * (A + A.transpose());
    dense::SymmetricEigen eigen = dense::symmetric_eigen(symmetric);
    vectors_ = std::move(eigen.vectors);
    frequency_ = eigen.values.cwiseMax(0.0).cwiseSqrt();
  }

  /// z and ż of the initial state.
  void coordinates(ConstVectorRef y0) {
    const auto n = static_cast<Index>(moving_.size());
    for (Index i = 0; i < n; ++i) {
      physical_[i] = y0[start_.size() + moving_[static_cast<std::size_t>(i)]] / inverse_root_mass_[i];
    }
    dz_.noalias() = vectors_.transpose() * physical_;
    z_.setZero();
  }

  /// g(t, Φz) = Qᵀ M^{-1/2} f(t, q) + Ω² Φz with q of Φz.
  void evaluate_rest(double t, const Vector& z, Vector& rest) {
    filtered_ = factors_.phi.cwiseProduct(z);
    physical_.noalias() = vectors_ * filtered_;
    for (std::size_t k = 0; k < moving_.size(); ++k) {
      const auto i = static_cast<Index>(k);
      position_[moving_[k]] = start_[moving_[k]] + physical_[i] * inverse_root_mass_[i];
    }
    system_.force(t, position_, velocity_, force_);
    ++work_.rhs_evaluations;
    for (std::size_t k = 0; k < moving_.size(); ++k) {
      const auto i = static_cast<Index>(k);
      physical_[i] = force_[moving_[k]] * inverse_root_mass_[i];
    }
    rest.noalias() = vectors_.transpose() * physical_;
    rest += frequency_.cwiseAbs2().cwiseProduct(filtered_);
  }

  TrigonometricFilter filter_;
  const SecondOrderSystem& system_;
  Work& work_;
  Vector start_, position_, velocity_, force_;
  std::vector<Index> moving_;
  Vector inverse_root_mass_, frequency_;
  Matrix vectors_;
  Factors factors_;
  double factors_step_ = 0.0;
  Vector z_, dz_, new_z_, new_dz_, filtered_, rest_, new_rest_, physical_;
};

}  // namespace

std::unique_ptr<Integrator> make_gautschi(const GautschiOptions& options) {
  MethodInfo info{.name = "gautschi",
                  .title = "Trigonometric (Gautschi, Deuflhard)",
                  .family = "exponential",
                  .order = 2,
                  .order_with_velocity_forces = 0,
                  .stages = 1,
                  .is_symplectic = options.filter != TrigonometricFilter::gautschi,
                  .is_symmetric = options.filter != TrigonometricFilter::gautschi,
                  .is_a_stable = true,
                  .needs = {Capability::second_order, Capability::position_forces},
                  .formula =
                      "x' = cos(hW) x + W^-1 sin(hW) v + ½h² Psi g;  v' = -W sin(hW) x + cos(hW) v + "
                      "½h (Psi0 g + Psi1 g');  g = f + W² x",
                  .reference =
                      "[Gautschi 1961; Deuflhard 1979; Hochbruck, Lubich 1999; Hairer, Lubich, Wanner 2006, "
                      "XIII.2]"};
  return std::make_unique<FixedStepIntegrator>(
      std::move(info), [options](const Ivp& ivp, double, Work& work) -> std::unique_ptr<Stepper> {
        return std::make_unique<GautschiStepper>(options.filter, ivp, work);
      });
}

}  // namespace fw::integrators
