#include "integrators/tableau/fully_implicit_runge_kutta.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <vector>

#include "integrators/implicit/stage_matrix.hpp"
#include "integrators/loop/stepper.hpp"
#include "integrators/tableau/extended_precision_steps.hpp"
#include "integrators/tableau/extended_runge_kutta.hpp"
#include "integrators/tableau/tableau_info.hpp"
#include "ode/pattern_watch.hpp"
#include "schemes/derived_properties.hpp"
#include "schemes/order_conditions.hpp"

namespace fw::integrators {

namespace {

using schemes::ButcherTableau;
using schemes::TableauValues;

constexpr double rounding = std::numeric_limits<double>::epsilon();

/// The coefficients with those of the reduction to accelerations: A² and bᵀA.
struct CoupledTableau {
  TableauValues<double> values{};
  std::vector<double> a_squared{}, b_position{};

  std::size_t stages() const { return static_cast<std::size_t>(values.stages); }
};

CoupledTableau couple(const ButcherTableau& tableau) {
  CoupledTableau result{.values = schemes::values<double>(tableau)};
  const TableauValues<Float128> exact = schemes::values<Float128>(tableau);
  const std::size_t s = result.stages();
  for (std::size_t i = 0; i < s; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (exact.c[i] == exact.c[j]) {
        throw std::logic_error("tableau \"" + tableau.name + "\": the nodes must be distinct");
      }
    }
  }
  for (std::size_t i = 0; i < s; ++i) {
    for (std::size_t j = 0; j < s; ++j) {
      Float128 sum = 0;
      for (std::size_t k = 0; k < s; ++k) sum += exact.a[i * s + k] * exact.a[k * s + j];
      // √ cancels in some entries: what is left of it is rounding.
      result.a_squared.push_back(abs(sum) < 1e-30 ? 0.0 : static_cast<double>(sum));
    }
    Float128 weight = 0;
    for (std::size_t k = 0; k < s; ++k) weight += exact.b[k] * exact.a[k * s + i];
    result.b_position.push_back(static_cast<double>(weight));
  }
  return result;
}

std::vector<char> present_blocks(const CoupledTableau& tableau, bool second_order) {
  std::vector<char> present(tableau.values.a.size());
  for (std::size_t k = 0; k < present.size(); ++k) {
    present[k] = tableau.values.a[k] != 0.0 || (second_order && tableau.a_squared[k] != 0.0) ? 1 : 0;
  }
  return present;
}

/// The slopes of all stages, one after the other, and where their iteration starts.
class CoupledStepper : public Stepper, protected linalg::NewtonProblem {
 public:
  CoupledStepper(const CoupledTableau& tableau, Index slope_size, const ImplicitOptions& options, Work& work)
      : tableau_(tableau),
        work_(work),
        newton_(slope_size * static_cast<Index>(tableau.stages()),
                {.tolerance = options.newton_tolerance, .rate_of_renewal = options.rate_of_renewal}),
        size_(slope_size),
        slopes_(Vector::Zero(slope_size * static_cast<Index>(tableau.stages()))),
        last_slopes_(slopes_),
        extrapolation_(tableau.values.a.size()) {}

  void restart(double, ConstVectorRef) override {
    slopes_.setZero();
    last_step_ = 0.0;
    newton_.forget_matrix();
  }
  void serialise(StateArchive& archive) override {
    archive.visit("slopes", slopes_);
    archive.visit("step of the slopes", last_step_);
    newton_.serialise(archive);
  }

 protected:
  /// Extrapolates the slopes of the last step to the nodes of this one; zero before the first.
  void predict(double h) {
    const std::size_t s = tableau_.stages();
    if (last_step_ == 0.0) return;
    if (h != extrapolation_step_ || last_step_ != extrapolation_last_) {
      for (std::size_t i = 0; i < s; ++i) {
        for (std::size_t j = 0; j < s; ++j) {
          double weight = 1.0;
          const double theta = 1.0 + tableau_.values.c[i] * h / last_step_;
          for (std::size_t k = 0; k < s; ++k) {
            if (k == j) continue;
            weight *= (theta - tableau_.values.c[k]) / (tableau_.values.c[j] - tableau_.values.c[k]);
          }
          extrapolation_[i * s + j] = weight;
        }
      }
      extrapolation_step_ = h;
      extrapolation_last_ = last_step_;
    }
    last_slopes_ = slopes_;
    for (std::size_t i = 0; i < s; ++i) {
      slope(i).setZero();
      for (std::size_t j = 0; j < s; ++j) {
        slope(i) += extrapolation_[i * s + j] * last_slopes_.segment(static_cast<Index>(j) * size_, size_);
      }
    }
  }
  void set_last_step(double h) { last_step_ = h; }

  Eigen::VectorBlock<Vector> slope(std::size_t i) {
    return slopes_.segment(static_cast<Index>(i) * size_, size_);
  }

  const CoupledTableau tableau_;
  Work& work_;
  linalg::SimplifiedNewton newton_;
  Index size_;
  Vector slopes_, last_slopes_;

 private:
  std::vector<double> extrapolation_;
  double last_step_ = 0.0, extrapolation_step_ = 0.0, extrapolation_last_ = 0.0;
};

class FirstOrderStepper final : public CoupledStepper {
 public:
  FirstOrderStepper(const CoupledTableau& tableau, const ImplicitOptions& options, const Ivp& ivp, Work& work)
      : CoupledStepper(tableau, ivp.y0.size(), options, work),
        system_(*ivp.system),
        watch_(system_.pattern_revision()),
        jacobian_(system_.jacobian_pattern()),
        matrix_(jacobian_, tableau.values.stages, present_blocks(tableau, false)),
        ones_(Vector::Ones(ivp.y0.size())),
        start_(ivp.y0.size()),
        state_(ivp.y0.size()),
        value_(ivp.y0.size()) {}

  Status step(double t, double h, VectorRef y) override {
    start_ = y;
    time_ = t;
    step_ = h;
    predict(h);
    const double floor = 16.0 * rounding * start_.lpNorm<Eigen::Infinity>() / h;
    if (Status status = newton_.solve(*this, slopes_, h, 0.0, floor, work_); !status.ok()) return status;
    for (std::size_t i = 0; i < tableau_.stages(); ++i) y += (h * tableau_.values.b[i]) * slope(i);
    set_last_step(h);
    return {};
  }

 private:
  void residual(ConstVectorRef k, VectorRef out) override {
    const std::size_t s = tableau_.stages();
    for (std::size_t i = 0; i < s; ++i) {
      state_ = start_;
      for (std::size_t j = 0; j < s; ++j) {
        const double weight = step_ * tableau_.values.a[i * s + j];
        if (weight != 0.0) state_ += weight * k.segment(static_cast<Index>(j) * size_, size_);
      }
      system_.rhs(time_ + tableau_.values.c[i] * step_, state_, value_);
      ++work_.rhs_evaluations;
      out.segment(static_cast<Index>(i) * size_, size_) =
          k.segment(static_cast<Index>(i) * size_, size_) - value_;
    }
  }
  const SparseMatrix& matrix(ConstVectorRef) override {
    if (watch_.has_changed(system_.pattern_revision())) {
      jacobian_ = system_.jacobian_pattern();
      matrix_ = StageMatrix(jacobian_, tableau_.values.stages, present_blocks(tableau_, false));
    }
    system_.jacobian(time_, start_, jacobian_);
    ++work_.jacobian_evaluations;
    return matrix_.assemble(ones_, {{jacobian_, tableau_.values.a, -step_}});
  }
  std::uint64_t pattern_revision() const override { return system_.pattern_revision(); }

  const OdeSystem& system_;
  PatternWatch watch_;
  SparseMatrix jacobian_;
  StageMatrix matrix_;
  Vector ones_, start_, state_, value_;
  double time_ = 0.0, step_ = 0.0;
};

class SecondOrderStepper final : public CoupledStepper {
  /// Of the forces that were evaluated last.
  auto acceleration(std::size_t i) {
    return forces_.segment(static_cast<Index>(i) * size_, size_).cwiseQuotient(system_.mass());
  }
  /// Forces that were evaluated keep momenta to rounding, which accelerations from linear systems do not. But
  /// positions of stages are sums that cancel, and a force on their rounding, times h² again, is ε (hω)⁴ of the
  /// state: far beyond the stiffness that a step resolves the accelerations of Newton's iteration are the better
  /// ones, ε (hω)².
  bool are_forces_known(double h) {
    constexpr double largest_defect = 1e-9;
    double defect = 0.0;
    for (std::size_t i = 0; i < tableau_.stages(); ++i) {
      defect = std::max(defect, h * h * (acceleration(i) - slope(i)).lpNorm<Eigen::Infinity>());
    }
    return defect <= largest_defect * (start_position_.lpNorm<Eigen::Infinity>() +
                                       h * start_velocity_.lpNorm<Eigen::Infinity>());
  }

 public:
  SecondOrderStepper(const CoupledTableau& tableau, const ImplicitOptions& options, const Ivp& ivp,
                     Work& work)
      : CoupledStepper(tableau, ivp.y0.size() / 2, options, work),
        system_(*ivp.system->second_order()),
        watch_(system_.pattern_revision()),
        stiffness_(system_.tangent_pattern()),
        damping_(stiffness_),
        matrix_(stiffness_, tableau.values.stages, present_blocks(tableau, true)),
        forces_(slopes_),
        start_position_(size_),
        start_velocity_(size_),
        position_(size_),
        velocity_(size_),
        force_(size_) {}

  Status step(double t, double h, VectorRef y) override {
    start_position_ = y.head(size_);
    start_velocity_ = y.tail(size_);
    time_ = t;
    step_ = h;
    predict(h);
    const double floor =
        16.0 * rounding *
        (start_position_.lpNorm<Eigen::Infinity>() / (h * h) + start_velocity_.lpNorm<Eigen::Infinity>() / h);
    if (Status status = newton_.solve(*this, slopes_, h, 0.0, floor, work_); !status.ok()) return status;
    y.head(size_) += h * start_velocity_;
    const bool takes_forces = are_forces_known(h);
    for (std::size_t i = 0; i < tableau_.stages(); ++i) {
      if (takes_forces) slope(i) = acceleration(i);
      y.head(size_) += (h * h * tableau_.b_position[i]) * slope(i);
      y.tail(size_) += (h * tableau_.values.b[i]) * slope(i);
    }
    set_last_step(h);
    return {};
  }

 private:
  void residual(ConstVectorRef k, VectorRef out) override {
    const std::size_t s = tableau_.stages();
    for (std::size_t i = 0; i < s; ++i) {
      position_ = start_position_ + (step_ * tableau_.values.c[i]) * start_velocity_;
      velocity_ = start_velocity_;
      for (std::size_t j = 0; j < s; ++j) {
        const double to_position = step_ * step_ * tableau_.a_squared[i * s + j];
        const double to_velocity = step_ * tableau_.values.a[i * s + j];
        const auto slope_j = k.segment(static_cast<Index>(j) * size_, size_);
        if (to_position != 0.0) position_ += to_position * slope_j;
        if (to_velocity != 0.0) velocity_ += to_velocity * slope_j;
      }
      system_.force(time_ + tableau_.values.c[i] * step_, position_, velocity_, force_);
      ++work_.rhs_evaluations;
      const Index first = static_cast<Index>(i) * size_;
      forces_.segment(first, size_) = force_;
      out.segment(first, size_) = system_.mass().cwiseProduct(k.segment(first, size_)) - force_;
    }
  }
  const SparseMatrix& matrix(ConstVectorRef) override {
    if (watch_.has_changed(system_.pattern_revision())) {
      stiffness_ = damping_ = system_.tangent_pattern();
      matrix_ = StageMatrix(stiffness_, tableau_.values.stages, present_blocks(tableau_, true));
    }
    system_.stiffness(time_, start_position_, start_velocity_, TangentModel::exact, stiffness_);
    system_.damping(time_, start_position_, start_velocity_, damping_);
    ++work_.jacobian_evaluations;
    return matrix_.assemble(system_.mass(), {{damping_, tableau_.values.a, -step_},
                                             {stiffness_, tableau_.a_squared, -step_ * step_}});
  }
  std::uint64_t pattern_revision() const override { return system_.pattern_revision(); }

  const SecondOrderSystem& system_;
  PatternWatch watch_;
  SparseMatrix stiffness_, damping_;
  StageMatrix matrix_;
  Vector forces_, start_position_, start_velocity_, position_, velocity_, force_;
  double time_ = 0.0, step_ = 0.0;
};

/// The same reduction of a Nyström method, whose coefficients are those of the reduction already.
CoupledTableau couple(const schemes::NystromTableau& tableau) {
  const schemes::NystromValues<double> numbers = schemes::values<double>(tableau);
  if (numbers.a_velocity.empty()) {
    throw std::logic_error("Nyström tableau \"" + tableau.name +
                           "\": coupled stages need a matrix of the velocities");
  }
  CoupledTableau result;
  result.values.stages = numbers.stages;
  result.values.a = numbers.a_velocity;
  result.values.b = numbers.b_velocity;
  result.values.c = numbers.c;
  result.values.name = tableau.name;
  result.a_squared = numbers.a_position;
  result.b_position = numbers.b_position;
  return result;
}

/// One step in binary128 by fixed-point iteration on the accelerations: for problems that are not stiff.
void extended_nystrom_step(const schemes::NystromValues<Float128>& tableau, const OdeSystem& system,
                           const Float128& t, const Float128& h, std::vector<Float128>& y) {
  const auto s = static_cast<std::size_t>(tableau.stages);
  const std::size_t n = y.size() / 2;
  std::vector<std::vector<Float128>> k(s, std::vector<Float128>(n, Float128(0)));
  std::vector<Float128> state(2 * n), slope(2 * n);
  constexpr int most_iterations = 200;
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    Float128 change = 0, size = 0;
    for (std::size_t i = 0; i < s; ++i) {
      for (std::size_t d = 0; d < n; ++d) {
        state[d] = y[d] + tableau.c[i] * h * y[n + d];
        state[n + d] = y[n + d];
      }
      for (std::size_t j = 0; j < s; ++j) {
        for (std::size_t d = 0; d < n; ++d) {
          state[d] += h * h * tableau.a_position[i * s + j] * k[j][d];
          state[n + d] += h * tableau.a_velocity[i * s + j] * k[j][d];
        }
      }
      system.rhs(Float128(t + tableau.c[i] * h), state, slope);
      for (std::size_t d = 0; d < n; ++d) {
        change = std::max(change, Float128(abs(slope[n + d] - k[i][d])));
        size = std::max(size, Float128(abs(slope[n + d])));
        k[i][d] = slope[n + d];
      }
    }
    if (change <= 1e-31 * size) break;
  }
  for (std::size_t d = 0; d < n; ++d) y[d] += h * y[n + d];
  for (std::size_t i = 0; i < s; ++i) {
    for (std::size_t d = 0; d < n; ++d) {
      y[d] += h * h * tableau.b_position[i] * k[i][d];
      y[n + d] += h * tableau.b_velocity[i] * k[i][d];
    }
  }
}

}  // namespace

std::unique_ptr<Integrator> make_fully_implicit_runge_kutta(const ButcherTableau& tableau,
                                                            const ImplicitOptions& options) {
  const CoupledTableau coupled = couple(tableau);
  MethodInfo info = tableau_info(tableau, "fully implicit Runge-Kutta");
  info.formula = "k_i = f(t + c_i h, y + h sum_j a_ij k_j);  y' = y + h sum_i b_i k_i";
  return std::make_unique<FixedStepIntegrator>(
      std::move(info),
      [=](const Ivp& ivp, double, Work& work) -> std::unique_ptr<Stepper> {
        if (ivp.system->second_order() != nullptr) {
          return std::make_unique<SecondOrderStepper>(coupled, options, ivp, work);
        }
        return std::make_unique<FirstOrderStepper>(coupled, options, ivp, work);
      },
      make_extended_runge_kutta(tableau));
}

std::unique_ptr<Integrator> make_implicit_nystrom(const schemes::NystromTableau& tableau,
                                                  const ImplicitOptions& options) {
  const CoupledTableau coupled = couple(tableau);
  const schemes::NystromValues<Float128> exact = schemes::values<Float128>(tableau);
  MethodInfo info{.name = tableau.name,
                  .title = tableau.title,
                  .family = "partitioned implicit Runge-Kutta",
                  .order = schemes::order_of_accuracy(tableau, false),
                  .order_with_velocity_forces = schemes::order_of_accuracy(tableau, true),
                  .stages = tableau.stages(),
                  .is_explicit = false,
                  .is_symplectic = schemes::is_symplectic(exact),
                  .is_symmetric = schemes::is_symmetric(exact),
                  .needs = {Capability::second_order},
                  .formula =
                      "k_i = M^-1 f(t + c_i h, x + c_i h v + h² sum_j A_ij k_j, v + h sum_j a_ij k_j);  "
                      "x' = x + h v + h² sum_i B_i k_i;  v' = v + h sum_i b_i k_i",
                  .reference = tableau.reference};
  return std::make_unique<FixedStepIntegrator>(
      std::move(info),
      [=](const Ivp& ivp, double, Work& work) -> std::unique_ptr<Stepper> {
        return std::make_unique<SecondOrderStepper>(coupled, options, ivp, work);
      },
      [exact](const Ivp& ivp, std::uint64_t steps) {
        return run_extended_steps(ivp, steps,
                                  [&](const Float128& t, const Float128& h, std::vector<Float128>& y) {
                                    extended_nystrom_step(exact, *ivp.system, t, h, y);
                                  });
      });
}

}  // namespace fw::integrators
