#include "integrators/tableau/nystrom.hpp"

#include <stdexcept>
#include <utility>
#include <vector>

#include "integrators/loop/adaptive_integrator.hpp"
#include "integrators/loop/stepper.hpp"
#include "integrators/tableau/linear_combination.hpp"
#include "schemes/derived_properties.hpp"
#include "schemes/order_conditions.hpp"

namespace fw::integrators {

namespace {

using schemes::NystromTableau;
using schemes::NystromValues;

void check_explicit(const NystromTableau& tableau) {
  const NystromValues<Float128> numbers = schemes::values<Float128>(tableau);
  const auto s = static_cast<std::size_t>(numbers.stages);
  for (std::size_t i = 0; i < s; ++i) {
    for (std::size_t j = i; j < s; ++j) {
      const bool velocity = !numbers.a_velocity.empty() && numbers.a_velocity[i * s + j] != 0;
      if (velocity || numbers.a_position[i * s + j] != 0) {
        throw std::logic_error("Nyström tableau \"" + tableau.name + "\" is not explicit");
      }
    }
  }
}

/// Whether the last stage is the new state: ā_sj = b̄_j, a_sj = b_j (if there is an a), c_s = 1.
bool is_first_same_as_last(const NystromTableau& tableau) {
  const NystromValues<Float128> numbers = schemes::values<Float128>(tableau);
  const auto s = static_cast<std::size_t>(numbers.stages);
  if (s < 2 || numbers.c[0] != 0 || numbers.c[s - 1] != 1) return false;
  for (std::size_t j = 0; j < s; ++j) {
    if (numbers.a_position[(s - 1) * s + j] != numbers.b_position[j]) return false;
    if (!numbers.a_velocity.empty() && numbers.a_velocity[(s - 1) * s + j] != numbers.b_velocity[j])
      return false;
  }
  return true;
}

/// The arithmetic of one step, in double and in Float128. States are (q, v) with n entries each.
template <class S>
class NystromKernel {
 public:
  NystromKernel(const NystromValues<S>& tableau, std::size_t n)
      : tableau_(tableau),
        n_(n),
        accelerations_(static_cast<std::size_t>(tableau.stages), std::vector<S>(n)),
        stage_(2 * n) {
    refresh_pointers();
  }

  /// All accelerations k_i; the first is left as it is where `has_first`. `acceleration(t, state, out)`
  /// evaluates M⁻¹f.
  template <class Acceleration>
  void evaluate_stages(const S& t, const S& h, const S* y, bool has_first, Acceleration acceleration) {
    const auto s = static_cast<std::size_t>(tableau_.stages);
    const S h_squared = h * h;
    for (std::size_t i = has_first ? 1 : 0; i < s; ++i) {
      move(S(tableau_.c[i] * h), y, stage_.data());
      linear_combination<S>(stage_.data(), h_squared, &tableau_.a_position[i * s], pointers_.data(), i,
                            stage_.data(), n_);
      if (!tableau_.a_velocity.empty()) {
        linear_combination<S>(stage_.data() + n_, h, &tableau_.a_velocity[i * s], pointers_.data(), i,
                              stage_.data() + n_, n_);
      }
      acceleration(S(t + tableau_.c[i] * h), stage_, accelerations_[i]);
    }
  }

  /// q' = q + h v + h² Σ b̄_i k_i, v' = v + h Σ b_i k_i. `out` may be `y`.
  void combine(const S& h, const S* y, const std::vector<S>& b_position, const std::vector<S>& b_velocity,
               S* out) {
    move(h, y, out);
    add(h, b_position, b_velocity, out);
  }

  /// out += (h² Σ b̄_i k_i, h Σ b_i k_i).
  void add(const S& h, const std::vector<S>& b_position, const std::vector<S>& b_velocity, S* out) {
    linear_combination<S>(out, S(h * h), b_position.data(), pointers_.data(), b_position.size(), out, n_);
    linear_combination<S>(out + n_, h, b_velocity.data(), pointers_.data(), b_velocity.size(), out + n_, n_);
  }

  /// The acceleration of the last stage becomes that of the first.
  void advance_first_stage() {
    accelerations_.front().swap(accelerations_.back());
    refresh_pointers();
  }

  std::vector<S>& first_acceleration() { return accelerations_.front(); }

  const NystromValues<S>& tableau() const { return tableau_; }

 private:
  /// out = (q + part·v, v).
  void move(const S& part, const S* y, S* out) const {
    for (std::size_t k = 0; k < n_; ++k) {
      out[k] = y[k] + part * y[n_ + k];
      out[n_ + k] = y[n_ + k];
    }
  }

  void refresh_pointers() {
    pointers_.clear();
    for (const std::vector<S>& acceleration : accelerations_) pointers_.push_back(acceleration.data());
  }

  NystromValues<S> tableau_;
  std::size_t n_;
  std::vector<std::vector<S>> accelerations_;
  std::vector<const S*> pointers_{};
  std::vector<S> stage_;
};

class NystromStepper final : public AdaptiveStepper {
 public:
  NystromStepper(const NystromValues<double>& tableau, bool first_same_as_last, const Ivp& ivp, Work& work)
      : kernel_(tableau, static_cast<std::size_t>(ivp.y0.size() / 2)),
        first_same_as_last_(first_same_as_last),
        system_(*ivp.system->second_order()),
        work_(work),
        inverse_mass_(system_.mass().cwiseInverse()) {
    for (std::size_t i = 0; i < tableau.b_position_embedded.size(); ++i) {
      error_position_.push_back(tableau.b_position[i] - tableau.b_position_embedded[i]);
      error_velocity_.push_back(tableau.b_velocity[i] - tableau.b_velocity_embedded[i]);
    }
  }

  Status step(double t, double h, VectorRef y) override {
    evaluate(t, h, y);
    kernel_.combine(h, y.data(), kernel_.tableau().b_position, kernel_.tableau().b_velocity, y.data());
    accept();
    return {};
  }

  Status attempt(double t, double h, ConstVectorRef y, VectorRef y_new, VectorRef error) override {
    evaluate(t, h, y);
    kernel_.combine(h, y.data(), kernel_.tableau().b_position, kernel_.tableau().b_velocity, y_new.data());
    error.setZero();
    kernel_.add(h, error_position_, error_velocity_, error.data());
    return {};
  }

  void accept() override {
    has_first_ = first_same_as_last_;
    if (first_same_as_last_) kernel_.advance_first_stage();
  }

  void restart(double, ConstVectorRef) override { has_first_ = false; }
  void serialise(StateArchive& archive) override {
    archive.visit("first acceleration", kernel_.first_acceleration());
    archive.visit("first acceleration is known", has_first_);
  }

 private:
  void evaluate(double t, double h, ConstVectorRef y) {
    const Index n = inverse_mass_.size();
    kernel_.evaluate_stages(t, h, y.data(), has_first_,
                            [&](double time, const std::vector<double>& state, std::vector<double>& out) {
                              const ConstVectorMap q(state.data(), n), v(state.data() + n, n);
                              VectorMap acceleration(out.data(), n);
                              system_.force(time, q, v, acceleration);
                              ++work_.rhs_evaluations;
                              acceleration.array() *= inverse_mass_.array();
                            });
    has_first_ = true;  // a repeated attempt starts from the same (t, y)
  }

  NystromKernel<double> kernel_;
  bool first_same_as_last_;
  const SecondOrderSystem& system_;
  Work& work_;
  Vector inverse_mass_;
  std::vector<double> error_position_{}, error_velocity_{};
  bool has_first_ = false;  ///< the first acceleration is that of the present state
};

std::vector<Float128> solve_extended(const NystromValues<Float128>& tableau, const Ivp& ivp,
                                     std::uint64_t steps) {
  std::vector<Float128> y = initial_state_extended(ivp);
  std::vector<Float128> slope(y.size());
  const std::size_t n = y.size() / 2;
  NystromKernel<Float128> kernel(tableau, n);
  const Float128 h = (Float128(ivp.t1) - Float128(ivp.t0)) / steps;
  for (std::uint64_t step = 0; step < steps; ++step) {
    const Float128 t = Float128(ivp.t0) + step * h;
    kernel.evaluate_stages(
        t, h, y.data(), false,
        [&](const Float128& time, const std::vector<Float128>& state, std::vector<Float128>& out) {
          ivp.system->rhs(time, state, slope);
          std::copy(slope.begin() + static_cast<std::ptrdiff_t>(n), slope.end(), out.begin());
        });
    kernel.combine(h, y.data(), tableau.b_position, tableau.b_velocity, y.data());
  }
  return y;
}

}  // namespace

std::unique_ptr<Integrator> make_nystrom(const NystromTableau& tableau, const ControllerOptions& controller) {
  check_explicit(tableau);
  const bool first_same_as_last = is_first_same_as_last(tableau);
  const NystromValues<double> rounded = schemes::values<double>(tableau);
  const NystromValues<Float128> exact = schemes::values<Float128>(tableau);
  const bool position_forces = tableau.A_velocity.empty();
  const bool adaptive = !tableau.b_position_embedded.empty();
  MethodInfo info{
      .name = tableau.name,
      .title = tableau.title,
      .family = "Runge-Kutta-Nystrom",
      .order = schemes::order_of_accuracy(tableau, false),
      .order_with_velocity_forces = schemes::order_of_accuracy(tableau, true),
      .stages = tableau.stages() - (first_same_as_last ? 1 : 0),
      .is_adaptive = adaptive,
      .embedded_order = schemes::embedded_order(tableau),
      .is_symplectic = schemes::is_symplectic(exact),
      .is_symmetric = schemes::is_symmetric(exact),
      .needs = position_forces ? Capabilities{Capability::second_order, Capability::position_forces}
                               : Capabilities{Capability::second_order},
      .formula = position_forces
                     ? "k_i = M^-1 f(t + c_i h, x + c_i h v + h² sum_j A_ij k_j);  "
                       "x' = x + h v + h² sum_i B_i k_i;  v' = v + h sum_i b_i k_i"
                     : "k_i = M^-1 f(t + c_i h, x + c_i h v + h² sum_j A_ij k_j, v + h sum_j a_ij k_j);  "
                       "x' = x + h v + h² sum_i B_i k_i;  v' = v + h sum_i b_i k_i",
      .reference = tableau.reference};
  const ExtendedSolver extended = [exact](const Ivp& ivp, std::uint64_t steps) {
    return solve_extended(exact, ivp, steps);
  };
  if (!adaptive) {
    return std::make_unique<FixedStepIntegrator>(
        std::move(info),
        [=](const Ivp& ivp, double, Work& work) -> std::unique_ptr<Stepper> {
          return std::make_unique<NystromStepper>(rounded, first_same_as_last, ivp, work);
        },
        extended);
  }
  return std::make_unique<AdaptiveIntegrator>(
      std::move(info), controller,
      [=](const Ivp& ivp, Work& work) -> std::unique_ptr<AdaptiveStepper> {
        return std::make_unique<NystromStepper>(rounded, first_same_as_last, ivp, work);
      },
      extended);
}

}  // namespace fw::integrators
