#include "integrators/tableau/rosenbrock.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "integrators/implicit/shifted_jacobian.hpp"
#include "integrators/loop/adaptive_integrator.hpp"
#include "integrators/loop/stepper.hpp"
#include "integrators/tableau/extended_precision_steps.hpp"
#include "integrators/tableau/linear_combination.hpp"
#include "schemes/order_conditions.hpp"

namespace fw::integrators {

namespace {

using schemes::RosenbrockTableau;

/// The increment of the time derivative as a fraction of the step.
/// Its truncation error, h⁴/4096² per step, stays below the error of the schemes of order 4 down to 1e-12,
/// its rounding (4096 ε relative to f) as well.
constexpr double time_increment = 1.0 / 4096.0;

/// The coefficients of the transformed form, computed in binary128.
struct TransformedTableau {
  std::size_t stages = 0;
  double gamma = 0.0;
  std::vector<double> a{}, c{};      ///< stages × stages, row by row, strictly lower triangular
  std::vector<double> m{}, error{};  ///< weights of y' and of y' − ŷ'
  std::vector<double> alpha_sum{}, gamma_sum{};
};

/// Γ⁻¹ of a lower triangular matrix by forward substitution, row by row.
std::vector<Float128> inverse(const std::vector<Float128>& gamma, std::size_t s) {
  std::vector<Float128> result(s * s, Float128(0));
  for (std::size_t j = 0; j < s; ++j) {
    for (std::size_t i = j; i < s; ++i) {
      Float128 sum = i == j ? 1 : 0;
      for (std::size_t k = j; k < i; ++k) sum -= gamma[i * s + k] * result[k * s + j];
      result[i * s + j] = sum / gamma[i * s + i];
    }
  }
  return result;
}

TransformedTableau transform(const RosenbrockTableau& tableau) {
  const auto s = static_cast<std::size_t>(tableau.stages());
  std::vector<Float128> alpha(s * s, Float128(0)), gamma(s * s, Float128(0));
  TransformedTableau result{.stages = s};
  for (std::size_t i = 0; i < s; ++i) {
    if (tableau.alpha[i].size() > i || tableau.gamma[i].size() != i + 1) {
      throw std::logic_error("tableau \"" + tableau.name + "\": alpha and gamma must be lower triangular");
    }
    Float128 alpha_sum = 0, gamma_sum = 0;
    for (std::size_t j = 0; j < tableau.alpha[i].size(); ++j) {
      alpha[i * s + j] = tableau.alpha[i][j].value();
      alpha_sum += alpha[i * s + j];
    }
    for (std::size_t j = 0; j <= i; ++j) {
      gamma[i * s + j] = tableau.gamma[i][j].value();
      gamma_sum += gamma[i * s + j];
    }
    if (gamma[i * s + i] != gamma[0] || gamma[0] == 0) {
      throw std::logic_error("tableau \"" + tableau.name + "\": gamma must have a constant diagonal");
    }
    result.alpha_sum.push_back(static_cast<double>(alpha_sum));
    // What is meant to be zero is zero: a stage without ∂f/∂t.
    result.gamma_sum.push_back(abs(gamma_sum) < 1e-30 ? 0.0 : static_cast<double>(gamma_sum));
  }
  result.gamma = static_cast<double>(gamma[0]);
  const std::vector<Float128> back = inverse(gamma, s);
  result.a.assign(s * s, 0.0);
  result.c.assign(s * s, 0.0);
  const auto weights = [&](std::size_t j, auto weight) {
    Float128 sum = 0;
    for (std::size_t k = j; k < s; ++k) sum += weight(k) * back[k * s + j];
    return static_cast<double>(sum);
  };
  for (std::size_t j = 0; j < s; ++j) {
    for (std::size_t i = j + 1; i < s; ++i) {
      result.a[i * s + j] = weights(j, [&](std::size_t k) { return alpha[i * s + k]; });
      result.c[i * s + j] = static_cast<double>(-back[i * s + j]);
    }
    result.m.push_back(weights(j, [&](std::size_t k) { return tableau.b[k].value(); }));
    if (tableau.b_embedded.empty()) continue;
    result.error.push_back(weights(
        j, [&](std::size_t k) -> Float128 { return tableau.b[k].value() - tableau.b_embedded[k].value(); }));
  }
  return result;
}

class RosenbrockStepper final : public AdaptiveStepper {
 public:
  RosenbrockStepper(const TransformedTableau& tableau, const Ivp& ivp, Work& work)
      : tableau_(tableau),
        system_(*ivp.system),
        work_(work),
        shift_(make_shifted_jacobian(*ivp.system, work)),
        stages_(tableau.stages, Vector(ivp.y0.size())),
        state_(ivp.y0.size()),
        slope_(ivp.y0.size()),
        other_slope_(ivp.y0.size()),
        time_derivative_(Vector::Zero(ivp.y0.size())),
        zero_(Vector::Zero(ivp.y0.size())) {
    for (const Vector& stage : stages_) pointers_.push_back(stage.data());
  }

  Status step(double t, double h, VectorRef y) override {
    if (Status status = solve_stages(t, h, y); !status.ok()) return status;
    combine(y, 1.0, tableau_.m.data(), tableau_.stages, y);
    return {};
  }

  Status attempt(double t, double h, ConstVectorRef y, VectorRef y_new, VectorRef error) override {
    if (Status status = solve_stages(t, h, y); !status.ok()) return status;
    combine(y, 1.0, tableau_.m.data(), tableau_.stages, y_new);
    combine(zero_, 1.0, tableau_.error.data(), tableau_.stages, error);
    return {};
  }

  void restart(double, ConstVectorRef) override { shift_->forget_matrix(); }
  void serialise(StateArchive& archive) override { shift_->serialise(archive); }

  void accept() override {}

 private:
  Status solve_stages(double t, double h, ConstVectorRef y) {
    const std::size_t s = tableau_.stages;
    const double eta = h * tableau_.gamma;
    if (Status status = shift_->factorise(t, y, eta); !status.ok()) return status;
    differentiate_in_time(t, h, y);
    for (std::size_t i = 0; i < s; ++i) {
      combine(y, 1.0, &tableau_.a[i * s], i, state_);
      evaluate(t + tableau_.alpha_sum[i] * h, state_, slope_);
      slope_ = eta * slope_ + (eta * h * tableau_.gamma_sum[i]) * time_derivative_;
      combine(slope_, tableau_.gamma, &tableau_.c[i * s], i, stages_[i]);
      if (Status status = shift_->solve(stages_[i]); !status.ok()) return status;
    }
    return {};
  }

  void evaluate(double t, ConstVectorRef y, VectorRef slope) {
    system_.rhs(t, y, slope);
    ++work_.rhs_evaluations;
  }

  /// f_t ≈ 4/3 · Δ(δ) − 1/3 · Δ(2δ) with Δ(δ) = (f(t + δ) − f(t − δ))/(2δ).
  void differentiate_in_time(double t, double h, ConstVectorRef y) {
    const double near_span = difference(t, h * time_increment, y, time_derivative_);
    if ((time_derivative_.array() == 0.0).all()) return;
    const double far_span = difference(t, 2.0 * h * time_increment, y, state_);
    time_derivative_ = (4.0 / 3.0 / near_span) * time_derivative_ - (1.0 / 3.0 / far_span) * state_;
  }

  /// f(t + δ) − f(t − δ); returns the distance of the two times as they are rounded.
  double difference(double t, double delta, ConstVectorRef y, Vector& out) {
    const double after = t + delta, before = t - delta;
    evaluate(after, y, slope_);
    evaluate(before, y, other_slope_);
    out = slope_ - other_slope_;
    return after - before;
  }

  void combine(ConstVectorRef base, double factor, const double* weights, std::size_t count, VectorRef out) {
    linear_combination<double>(base.data(), factor, weights, pointers_.data(), count, out.data(),
                               static_cast<std::size_t>(out.size()));
  }

  const TransformedTableau tableau_;
  const OdeSystem& system_;
  Work& work_;
  std::unique_ptr<ShiftedJacobian> shift_;
  std::vector<Vector> stages_;  ///< u_i
  std::vector<const double*> pointers_{};
  Vector state_, slope_, other_slope_, time_derivative_, zero_;
};

/// α, γ, b in binary128, untransformed.
struct ExtendedTableau {
  std::size_t stages = 0;
  std::vector<Float128> alpha{}, gamma{}, b{};

  explicit ExtendedTableau(const RosenbrockTableau& tableau)
      : stages(tableau.b.size()), alpha(stages * stages, Float128(0)), gamma(stages * stages, Float128(0)) {
    for (std::size_t i = 0; i < stages; ++i) {
      for (std::size_t j = 0; j < tableau.alpha[i].size(); ++j)
        alpha[i * stages + j] = tableau.alpha[i][j].value();
      for (std::size_t j = 0; j <= i; ++j) gamma[i * stages + j] = tableau.gamma[i][j].value();
      b.push_back(tableau.b[i].value());
    }
  }
};

/// One step in the form of the definition, with dense elimination: the slow twin of the stepper.
void extended_step(const ExtendedTableau& tableau, const OdeSystem& system, const Float128& t,
                   const Float128& h, std::vector<Float128>& y) {
  const std::size_t n = y.size(), s = tableau.stages;
  const std::vector<Float128> J = extended_jacobian(system, t, y);
  std::vector<Float128> before(n), after(n), time_derivative(n);
  const Float128 increment = 1e-11;
  system.rhs(Float128(t - increment), y, before);
  system.rhs(Float128(t + increment), y, after);
  for (std::size_t i = 0; i < n; ++i) time_derivative[i] = (after[i] - before[i]) / (2 * increment);
  std::vector<std::vector<Float128>> k(s, std::vector<Float128>(n));
  std::vector<Float128> argument(n), carried(n);
  Float128 factorised = 0;  // the diagonal h γ_ii of the matrix that `lu` has; all stages mostly share it
  std::optional<ExtendedLu> lu;
  for (std::size_t stage = 0; stage < s; ++stage) {
    Float128 alpha_sum = 0, gamma_sum = tableau.gamma[stage * s + stage];
    argument = y;
    std::fill(carried.begin(), carried.end(), Float128(0));
    for (std::size_t j = 0; j < stage; ++j) {
      const Float128 alpha = tableau.alpha[stage * s + j], gamma = tableau.gamma[stage * s + j];
      alpha_sum += alpha;
      gamma_sum += gamma;
      for (std::size_t i = 0; i < n; ++i) {
        argument[i] += alpha * k[j][i];
        carried[i] += gamma * k[j][i];
      }
    }
    system.rhs(Float128(t + alpha_sum * h), argument, k[stage]);
    const Float128 diagonal = h * tableau.gamma[stage * s + stage];
    if (stage == 0 || diagonal != factorised) {
      std::vector<Float128> matrix(n * n);
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) {
          matrix[i * n + j] = (i == j ? Float128(1) : Float128(0)) - diagonal * J[i * n + j];
        }
      }
      lu.emplace(std::move(matrix), n);
      factorised = diagonal;
    }
    for (std::size_t i = 0; i < n; ++i) {
      Float128 sum = 0;
      for (std::size_t j = 0; j < n; ++j) sum += J[i * n + j] * carried[j];
      k[stage][i] = h * k[stage][i] + h * sum + gamma_sum * h * h * time_derivative[i];
    }
    lu->solve(k[stage]);
  }
  for (std::size_t stage = 0; stage < s; ++stage) {
    for (std::size_t i = 0; i < n; ++i) y[i] += tableau.b[stage] * k[stage][i];
  }
}

}  // namespace

std::unique_ptr<Integrator> make_rosenbrock(const RosenbrockTableau& tableau,
                                            const ControllerOptions& controller) {
  const TransformedTableau transformed = transform(tableau);
  MethodInfo info{
      .name = tableau.name, .title = tableau.title, .family = "Rosenbrock", .reference = tableau.reference};
  info.order = info.order_with_velocity_forces = schemes::order_of_accuracy(tableau);
  info.embedded_order = schemes::embedded_order(tableau);
  info.is_adaptive = !tableau.b_embedded.empty();
  info.stages = tableau.stages();
  info.is_explicit = false;
  info.formula =
      "(I - h g J) k_i = h f(t + a_i h, y + sum_{j<i} a_ij k_j) + h J sum_{j<i} g_ij k_j + g_i h^2 f_t;  "
      "y' = y + sum_i b_i k_i";
  const ExtendedTableau exact(tableau);
  const ExtendedSolver extended = [exact](const Ivp& ivp, std::uint64_t steps) {
    return run_extended_steps(ivp, steps,
                              [&](const Float128& t, const Float128& h, std::vector<Float128>& y) {
                                extended_step(exact, *ivp.system, t, h, y);
                              });
  };
  if (!info.is_adaptive) {
    return std::make_unique<FixedStepIntegrator>(
        std::move(info),
        [transformed](const Ivp& ivp, double, Work& work) -> std::unique_ptr<Stepper> {
          return std::make_unique<RosenbrockStepper>(transformed, ivp, work);
        },
        extended);
  }
  return std::make_unique<AdaptiveIntegrator>(
      std::move(info), controller,
      [transformed](const Ivp& ivp, Work& work) -> std::unique_ptr<AdaptiveStepper> {
        return std::make_unique<RosenbrockStepper>(transformed, ivp, work);
      },
      extended);
}

}  // namespace fw::integrators
