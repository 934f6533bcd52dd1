#include "analysis/theory/scheme_growth.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "ode/functor_system.hpp"
#include "schemes/derived_properties.hpp"
#include "schemes/multistep_properties.hpp"

namespace fw::analysis {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

/// ẏ = λ y as a real system.
struct PlanarFlow {
  double real, imaginary;
  template <class S>
  void operator()(const S&, std::span<const S> y, std::span<S> dydt) const {
    dydt[0] = S(real) * y[0] - S(imaginary) * y[1];
    dydt[1] = S(imaginary) * y[0] + S(real) * y[1];
  }
};

struct Decay {
  double lambda;
  template <class S>
  void operator()(const S&, std::span<const S> y, std::span<S> dydt) const {
    dydt[0] = S(lambda) * y[0];
  }
};

struct Vibration {
  double omega_squared, damping;
  template <class S>
  void operator()(const S&, std::span<const S> q, std::span<const S> v, std::span<S> f) const {
    f[0] = -(S(omega_squared) * q[0] + S(damping) * v[0]);
  }
};

std::shared_ptr<const OdeSystem> vibration(double a, double b) {
  return std::make_shared<FunctorSecondOrderSystem<Vibration>>(
      Vector::Ones(1), b == 0.0 ? ForceClass::position : ForceClass::velocity, Vibration{a, b});
}

/// Of a real 2×2 matrix by trace and determinant. What touches the unit circle within rounding lies on it.
double spectral_radius(const Eigen::Matrix2d& m) {
  const double trace = m.trace(), determinant = m.determinant();
  if (!std::isfinite(trace) || !std::isfinite(determinant)) return infinity;
  const double discriminant = 0.25 * trace * trace - determinant;
  const double radius =
      discriminant <= 0.0 ? std::sqrt(determinant) : std::abs(0.5 * trace) + std::sqrt(discriminant);
  constexpr double rounding = 1e-12;
  const bool is_stable = std::abs(trace) <= 1.0 + determinant + rounding && determinant <= 1.0 + rounding;
  return is_stable ? std::min(radius, 1.0) : radius;
}

double spectral_radius(const Matrix& m) {
  if (!m.allFinite()) return infinity;
  return Eigen::EigenSolver<Matrix>(m, false).eigenvalues().cwiseAbs().maxCoeff();
}

/// The states after `steps` steps of length h, one per step; empty if a step fails.
std::vector<Vector> states_after(const Integrator& integrator, const std::shared_ptr<const OdeSystem>& system,
                                 double h, int steps, const Vector& start) {
  TrajectoryRecorder recorder;
  const Solution solution =
      integrator.solve({system, 0.0, h * steps, start, {}}, FixedStep{.step = h}, recorder);
  return solution.status.ok() ? recorder.states() : std::vector<Vector>{};
}

/// Whether single steps from a state tell all of a scheme.
bool carries_more(const MethodInfo& info) {
  return info.is_multistep || info.carries_more_than_state;
}

/// The matrix of a step on the moving part of a linear system, velocities in units of 1/h.
///
/// A scheme that keeps more than the state is known by its positions: x_{n+1} = P x_n + Q x_{n−1} is fitted
/// to three steps from every unit state. A fourth step tells whether there is such a recurrence.
Matrix step_matrix(const Integrator& integrator, const std::shared_ptr<const OdeSystem>& system, double h) {
  const SecondOrderSystem* second_order = system->second_order();
  const Index size = system->size(), n = second_order != nullptr ? size / 2 : size;
  std::vector<Index> moving;
  for (Index i = 0; i < size; ++i) {
    if (second_order == nullptr || !second_order->fixed()[static_cast<std::size_t>(i % n)])
      moving.push_back(i);
  }
  const auto unit = [&](Index i) { return second_order != nullptr && i >= n ? 1.0 / h : 1.0; };
  const auto m = static_cast<Index>(moving.size());
  const bool fits_positions = carries_more(integrator.info()) && second_order != nullptr;
  const int steps = fits_positions ? 4 : 1;
  std::vector<Matrix> after(static_cast<std::size_t>(steps) + 1, Matrix(m, m));
  for (Index j = 0; j < m; ++j) {
    const Index column = moving[static_cast<std::size_t>(j)];
    Vector start = Vector::Zero(size);
    start[column] = unit(column);
    const std::vector<Vector> states = states_after(integrator, system, h, steps, start);
    if (states.empty()) return Matrix::Constant(m, m, infinity);
    for (std::size_t k = 0; k < states.size(); ++k) {
      for (Index i = 0; i < m; ++i) {
        const Index row = moving[static_cast<std::size_t>(i)];
        after[k](i, j) = states[k][row] / unit(row);
      }
    }
  }
  if (!fits_positions) return after[1];
  const Index half = m / 2;
  Matrix window(m, m), next(m, m);
  window << after[2].topRows(half), after[1].topRows(half);
  next << after[3].topRows(half), after[2].topRows(half);
  const Matrix transition = window.transpose().fullPivLu().solve(next.transpose()).transpose();
  const Matrix predicted = (transition * next).topRows(half);
  const double size_of_step = after[4].topRows(half).cwiseAbs().maxCoeff();
  constexpr double allowed = 1e-6;
  if (!((predicted - after[4].topRows(half)).cwiseAbs().maxCoeff() <= allowed * (size_of_step + 1.0)))
    return Matrix::Constant(m, m, not_known);
  return transition;
}

double growth_of_steps(const Integrator& integrator, const std::shared_ptr<const OdeSystem>& system,
                       double h) {
  const Matrix m = step_matrix(integrator, system, h);
  if (m.hasNaN()) return not_known;
  if (m.rows() == 2 && m.cols() == 2) return spectral_radius(Eigen::Matrix2d(m));
  return spectral_radius(m);
}

/// x_{n+1} = P x_n + Q x_{n−1} on (x_n, x_{n−1}).
Matrix companion(const Matrix& P, const Matrix& Q) {
  const Index n = P.rows();
  Matrix m(2 * n, 2 * n);
  m << P, Q, Matrix::Identity(n, n), Matrix::Zero(n, n);
  return m;
}

/// Of z̈ = −Wz − Cż with a = h²W, b = hC.
Matrix verlet_recurrence(LinearRule rule, const Matrix& a, const Matrix& b) {
  const Index n = a.rows();
  const Matrix one = Matrix::Identity(n, n);
  if (rule == LinearRule::verlet_backward_velocity) return companion(2.0 * one - a - b, b - one);
  const Eigen::PartialPivLU<Matrix> implicit((one + 0.5 * b).eval());
  return companion(implicit.solve(2.0 * one - a), implicit.solve(0.5 * b - one));
}

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

/// A Nyström method in double.
struct SchemeGrowth::Stages {
  Index count;
  Matrix a_position, a_velocity;
  Vector c, b_position, b_velocity;
  bool has_velocity;  ///< coefficients for forces that depend on velocity
  bool is_diagonal;   ///< no stage needs a later one

  explicit Stages(const schemes::NystromValues<Float128>& t)
      : count(t.stages),
        a_position(Matrix::Zero(count, count)),
        a_velocity(Matrix::Zero(count, count)),
        c(count),
        b_position(count),
        b_velocity(count),
        has_velocity(!t.a_velocity.empty()) {
    for (Index i = 0; i < count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      c[i] = static_cast<double>(t.c[k]);
      b_position[i] = static_cast<double>(t.b_position[k]);
      b_velocity[i] = static_cast<double>(t.b_velocity[k]);
      for (Index j = 0; j < count; ++j) {
        const auto entry = static_cast<std::size_t>(i * count + j);
        a_position(i, j) = static_cast<double>(t.a_position[entry]);
        if (has_velocity) a_velocity(i, j) = static_cast<double>(t.a_velocity[entry]);
      }
    }
    is_diagonal = a_position.triangularView<Eigen::StrictlyUpper>().toDenseMatrix().isZero(0.0) &&
                  a_velocity.triangularView<Eigen::StrictlyUpper>().toDenseMatrix().isZero(0.0);
  }

  /// On (q, hv) of q̈ = −ω²q − cq̇ with a = h²ω², b = hc: stages k = h²q̈.
  Eigen::Matrix2d of_vibration(double a, double b) const {
    const Matrix system = Matrix::Identity(count, count) + a * a_position + b * a_velocity;
    Matrix right(count, 2);
    right.col(0).setConstant(-a);
    right.col(1) = -a * c - Vector::Constant(count, b);
    const Matrix k = system.partialPivLu().solve(right);
    Eigen::Matrix2d m;
    m << 1.0, 1.0, 0.0, 1.0;
    m.row(0) += b_position.transpose() * k;
    m.row(1) += b_velocity.transpose() * k;
    return m;
  }

  /// On (z, h ż) of z̈ = −Wz − Cż.
  Matrix of_system(const Matrix& W, const Matrix& C, double h) const {
    const Index n = W.rows();
    const Matrix a = h * h * W, b = h * C;
    Matrix position = Matrix::Zero(n, 2 * n), velocity = Matrix::Zero(n, 2 * n);
    position.leftCols(n).setIdentity();
    velocity.rightCols(n).setIdentity();
    std::vector<Matrix> k(static_cast<std::size_t>(count), Matrix::Zero(n, 2 * n));
    if (is_diagonal) {
      for (Index i = 0; i < count; ++i) {
        Matrix x = position + c[i] * velocity, v = velocity;
        for (Index j = 0; j < i; ++j) {
          if (a_position(i, j) != 0.0) x += a_position(i, j) * k[static_cast<std::size_t>(j)];
          if (a_velocity(i, j) != 0.0) v += a_velocity(i, j) * k[static_cast<std::size_t>(j)];
        }
        Matrix right = -a * x - b * v;
        if (a_position(i, i) != 0.0 || a_velocity(i, i) != 0.0) {
          const Matrix system = Matrix::Identity(n, n) + a_position(i, i) * a + a_velocity(i, i) * b;
          right = system.partialPivLu().solve(right).eval();
        }
        k[static_cast<std::size_t>(i)] = right;
      }
    } else {
      Matrix system = Matrix::Identity(count * n, count * n), right(count * n, 2 * n);
      for (Index i = 0; i < count; ++i) {
        right.middleRows(i * n, n) = -a * (position + c[i] * velocity) - b * velocity;
        for (Index j = 0; j < count; ++j)
          system.block(i * n, j * n, n, n) += a_position(i, j) * a + a_velocity(i, j) * b;
      }
      const Matrix all = system.partialPivLu().solve(right);
      for (Index i = 0; i < count; ++i) k[static_cast<std::size_t>(i)] = all.middleRows(i * n, n);
    }
    Matrix m(2 * n, 2 * n);
    m << position + velocity, velocity;
    for (Index i = 0; i < count; ++i) {
      m.topRows(n) += b_position[i] * k[static_cast<std::size_t>(i)];
      m.bottomRows(n) += b_velocity[i] * k[static_cast<std::size_t>(i)];
    }
    return m;
  }
};

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
    case GrowthBasis::exponential:
      return "exp(z)";
    case GrowthBasis::single_steps:
      return "single steps";
  }
  return "";
}

SchemeGrowth::SchemeGrowth(std::shared_ptr<const Integrator> integrator, const LinearScheme& scheme)
    : integrator_(std::move(integrator)), basis_(GrowthBasis::single_steps), rule_(scheme.rule) {
  const schemes::SchemeData& data = scheme.data;
  if (const auto* tableau = std::get_if<schemes::ButcherTableau>(&data)) {
    basis_ = GrowthBasis::stability_function;
    R_ = schemes::stability_function(*tableau);
  } else if (const auto* rosenbrock = std::get_if<schemes::RosenbrockTableau>(&data)) {
    basis_ = GrowthBasis::stability_function;
    R_ = schemes::stability_function(*rosenbrock);
  } else if (const auto* formula = std::get_if<schemes::MultistepFormula>(&data)) {
    basis_ = GrowthBasis::characteristic_polynomial;
    formula_ = *formula;
  } else if (const auto nystrom = schemes::nystrom_values(data)) {
    basis_ = GrowthBasis::oscillator_matrix;
    stages_ = std::make_shared<const Stages>(*nystrom);
  } else if (rule_ == LinearRule::exact) {
    basis_ = GrowthBasis::exponential;
  } else if (rule_ != LinearRule::of_coefficients) {
    basis_ = GrowthBasis::two_step_recurrence;
  }
  grows_at_every_step_ = find_growth_at_every_step(data);
}

/// An interval on the imaginary axis that is shorter is what rounding of coefficients leaves of none: with
/// 16-digit coefficients |R(iy)|² − 1 ~ C y^{2k} is lost below.
constexpr double shortest_interval = 0.01;

bool SchemeGrowth::find_growth_at_every_step(const schemes::SchemeData& data) const {
  switch (basis_) {
    case GrowthBasis::stability_function:
      return schemes::linear_stability(*R_).imaginary_interval < shortest_interval;
    case GrowthBasis::characteristic_polynomial: {
      constexpr double above_rounding = 1e-27;
      return principal_excess(*formula_, 0.01) > above_rounding &&
             principal_excess(*formula_, 0.02) > above_rounding;
    }
    case GrowthBasis::oscillator_matrix:
      return schemes::oscillator_stability(*schemes::nystrom_values(data)).interval < shortest_interval;
    case GrowthBasis::two_step_recurrence:  // Verlet's without damping, stable up to ωh = 2
    case GrowthBasis::exponential:
      return false;
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
      if (integrator_->info().needs.has(Capability::position_forces) && z.real() != 0.0) return not_known;
      return std::exp(z.real());
    case GrowthBasis::oscillator_matrix:
    case GrowthBasis::two_step_recurrence:
      break;
    case GrowthBasis::single_steps:
      if (integrator_->info().needs.has(Capability::second_order) || carries_more(integrator_->info())) break;
      return growth_of_steps(
          *integrator_, std::make_shared<FunctorSystem<PlanarFlow>>(2, PlanarFlow{z.real(), z.imag()}), 1.0);
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
      if (b != 0.0 && !stages_->has_velocity) return not_known;
      return spectral_radius(stages_->of_vibration(a, b));
    case GrowthBasis::two_step_recurrence:
      return spectral_radius(
          Eigen::Matrix2d(verlet_recurrence(rule_, Matrix::Constant(1, 1, a), Matrix::Constant(1, 1, b))));
    case GrowthBasis::single_steps:
      break;
  }
  return of_single_steps_on_vibration(a, b);
}

double SchemeGrowth::of_single_steps_on_vibration(double a, double b) const {
  const std::shared_ptr<const OdeSystem> system = vibration(a, b);
  if (!why_not_applicable(integrator_->info(), *system).empty()) return not_known;
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
    if (!stages_->has_velocity) return not_known;
    return spectral_radius(stages_->of_system(modes.stiffness, modes.damping, h));
  }
  double largest = 0.0;
  const bool by_eigenvalue = is_by_eigenvalue() || modes.vibrations.empty();
  const auto consider = [&](double growth) {
    largest = std::isnan(growth) || std::isnan(largest) ? not_known : std::max(largest, growth);
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
  const std::vector<Vector> states = states_after(
      *integrator_, std::make_shared<FunctorSystem<Decay>>(1, Decay{x}), 1.0, 1, Vector::Ones(1));
  return states.empty() ? std::nullopt : std::optional(states.back()[0]);
}

}  // namespace fw::analysis
