#include "integrators/tableau/explicit_runge_kutta.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "integrators/loop/adaptive_integrator.hpp"
#include "integrators/loop/continuous_extension.hpp"
#include "integrators/loop/stepper.hpp"
#include "integrators/tableau/linear_combination.hpp"
#include "integrators/tableau/tableau_info.hpp"
#include "schemes/derived_properties.hpp"

namespace fw::integrators {

namespace {

using schemes::ButcherTableau;
using schemes::TableauValues;

class ExplicitRungeKuttaStepper final : public AdaptiveStepper, public ContinuousExtension {
 public:
  ExplicitRungeKuttaStepper(const TableauValues<double>& tableau, bool first_same_as_last, const Ivp& ivp,
                            Work& work)
      : tableau_(tableau),
        first_same_as_last_(first_same_as_last),
        system_(*ivp.system),
        work_(work),
        slopes_(static_cast<std::size_t>(tableau.stages), Vector::Zero(ivp.y0.size())),
        stage_(ivp.y0.size()),
        error_weights_(tableau.b),
        dense_weights_(tableau.dense.size()) {
    for (std::size_t i = 0; i < tableau.b_embedded.size(); ++i) error_weights_[i] -= tableau.b_embedded[i];
    if (tableau.b_embedded.empty()) std::fill(error_weights_.begin(), error_weights_.end(), 0.0);
    refresh_pointers();
  }

  Status step(double t, double h, VectorRef y) override {
    evaluate_stages(t, h, y);
    if (first_same_as_last_) {
      y = stage_;
    } else {
      combine(y, h, tableau_.b, y);
    }
    accept();
    return {};
  }

  Status attempt(double t, double h, ConstVectorRef y, VectorRef y_new, VectorRef error) override {
    evaluate_stages(t, h, y);
    if (first_same_as_last_) {
      y_new = stage_;
    } else {
      combine(y, h, tableau_.b, y_new);
    }
    linear_combination<double>(zero(error), h, error_weights_.data(), pointers_.data(), error_weights_.size(),
                               error.data(), static_cast<std::size_t>(error.size()));
    return {};
  }

  void accept() override {
    // The continuous extension needs the slopes of this step until the next one begins.
    has_first_slope_ = false;
    advance_slope_ = first_same_as_last_;
  }

  void restart(double, ConstVectorRef) override { has_first_slope_ = advance_slope_ = false; }
  void serialise(StateArchive& archive) override {
    archive.visit("slopes", slopes_);
    archive.visit("first slope is known", has_first_slope_);
    archive.visit("last slope is the next first", advance_slope_);
  }

  bool has_continuous_weights() const override { return !tableau_.dense.empty(); }

  void extend(double theta, double h, ConstVectorRef start, VectorRef out) override {
    for (std::size_t i = 0; i < dense_weights_.size(); ++i) {
      double value = 0.0;
      const std::vector<double>& polynomial = tableau_.dense[i];
      for (std::size_t k = polynomial.size(); k-- > 0;) value = (value + polynomial[k]) * theta;
      dense_weights_[i] = value;
    }
    combine(start, h, dense_weights_, out);
  }

 private:
  void evaluate_stages(double t, double h, ConstVectorRef y) {
    const int s = tableau_.stages;
    if (advance_slope_) {
      slopes_.front().swap(slopes_.back());
      refresh_pointers();
      advance_slope_ = false;
      has_first_slope_ = true;
    }
    if (!has_first_slope_) {
      system_.rhs(t + tableau_.c.front() * h, y, slopes_.front());
      ++work_.rhs_evaluations;
      has_first_slope_ = true;  // a repeated attempt starts from the same (t, y)
    }
    const auto size = static_cast<std::size_t>(y.size());
    for (int i = 1; i < s; ++i) {
      linear_combination<double>(y.data(), h, &tableau_.a[static_cast<std::size_t>(i * s)], pointers_.data(),
                                 static_cast<std::size_t>(i), stage_.data(), size);
      system_.rhs(t + tableau_.c[static_cast<std::size_t>(i)] * h, stage_,
                  slopes_[static_cast<std::size_t>(i)]);
      ++work_.rhs_evaluations;
    }
  }

  void combine(ConstVectorRef base, double h, const std::vector<double>& weights, VectorRef out) {
    linear_combination<double>(base.data(), h, weights.data(), pointers_.data(), weights.size(), out.data(),
                               static_cast<std::size_t>(out.size()));
  }

  const double* zero(VectorRef error) {
    error.setZero();
    return error.data();
  }

  void refresh_pointers() {
    pointers_.clear();
    for (const Vector& slope : slopes_) pointers_.push_back(slope.data());
  }

  TableauValues<double> tableau_;
  bool first_same_as_last_;
  const OdeSystem& system_;
  Work& work_;
  std::vector<Vector> slopes_;
  std::vector<const double*> pointers_{};
  Vector stage_;
  std::vector<double> error_weights_, dense_weights_;
  bool has_first_slope_ = false;  ///< slopes_.front() is f at the start of the step to come
  bool advance_slope_ = false;    ///< slopes_.back() is f at the start of the step to come
};

/// The same steps in binary128; the plain loops are the slow twin of the stepper above.
std::vector<Float128> solve_extended(const TableauValues<Float128>& tableau, const Ivp& ivp,
                                     std::uint64_t steps) {
  std::vector<Float128> y = initial_state_extended(ivp);
  std::vector<Float128> stage(y.size());
  const auto s = static_cast<std::size_t>(tableau.stages);
  std::vector<std::vector<Float128>> slopes(s, y);
  const Float128 h = (Float128(ivp.t1) - Float128(ivp.t0)) / steps;
  for (std::uint64_t n = 0; n < steps; ++n) {
    const Float128 t = Float128(ivp.t0) + n * h;
    for (std::size_t i = 0; i < s; ++i) {
      stage = y;
      for (std::size_t j = 0; j < i; ++j) {
        const Float128 weight = h * tableau.a[i * s + j];
        if (weight == 0) continue;
        for (std::size_t k = 0; k < y.size(); ++k) stage[k] += weight * slopes[j][k];
      }
      ivp.system->rhs(Float128(t + tableau.c[i] * h), stage, slopes[i]);
    }
    for (std::size_t i = 0; i < s; ++i) {
      for (std::size_t k = 0; k < y.size(); ++k) y[k] += h * tableau.b[i] * slopes[i][k];
    }
  }
  return y;
}

}  // namespace

std::unique_ptr<Integrator> make_explicit_runge_kutta(const ButcherTableau& tableau,
                                                      const ControllerOptions& controller) {
  if (shape(tableau) != schemes::TableauShape::explicit_stages) {
    throw std::logic_error("tableau \"" + tableau.name + "\" is not explicit");
  }
  const TableauValues<Float128> exact = schemes::values<Float128>(tableau);
  const TableauValues<double> rounded = schemes::values<double>(tableau);
  const bool first_same_as_last = schemes::is_first_same_as_last(tableau);
  MethodInfo info = tableau_info(tableau, "explicit Runge-Kutta");
  info.stages = tableau.stages() - (first_same_as_last ? 1 : 0);
  info.formula = "k_i = f(t + c_i h, y + h sum_j a_ij k_j);  y' = y + h sum_i b_i k_i";
  const ExtendedSolver extended = [exact](const Ivp& ivp, std::uint64_t steps) {
    return solve_extended(exact, ivp, steps);
  };
  if (tableau.b_embedded.empty()) {
    return std::make_unique<FixedStepIntegrator>(
        std::move(info),
        [=](const Ivp& ivp, double, Work& work) -> std::unique_ptr<Stepper> {
          return std::make_unique<ExplicitRungeKuttaStepper>(rounded, first_same_as_last, ivp, work);
        },
        extended);
  }
  return std::make_unique<AdaptiveIntegrator>(
      std::move(info), controller,
      [=](const Ivp& ivp, Work& work) -> std::unique_ptr<AdaptiveStepper> {
        return std::make_unique<ExplicitRungeKuttaStepper>(rounded, first_same_as_last, ivp, work);
      },
      extended);
}

}  // namespace fw::integrators
