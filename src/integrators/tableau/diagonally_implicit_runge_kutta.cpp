#include "integrators/tableau/diagonally_implicit_runge_kutta.hpp"

#include <stdexcept>
#include <vector>

#include "integrators/loop/adaptive_integrator.hpp"
#include "integrators/loop/stepper.hpp"
#include "integrators/tableau/extended_runge_kutta.hpp"
#include "integrators/tableau/linear_combination.hpp"
#include "integrators/tableau/tableau_info.hpp"

namespace fw::integrators {

namespace {

using schemes::ButcherTableau;
using schemes::TableauValues;

/// Whether the last stage is the solution, so that an explicit first stage need not be evaluated anew.
bool is_first_same_as_last(const TableauValues<Float128>& tableau) {
  const int s = tableau.stages;
  if (s < 2 || tableau.A(0, 0) != 0) return false;
  for (int j = 0; j < s; ++j) {
    if (tableau.A(s - 1, j) != tableau.b[static_cast<std::size_t>(j)]) return false;
  }
  return true;
}

class DiagonallyImplicitStepper final : public AdaptiveStepper {
 public:
  DiagonallyImplicitStepper(const TableauValues<double>& tableau, bool first_same_as_last,
                            const ImplicitOptions& options, const Ivp& ivp, Work& work)
      : tableau_(tableau),
        first_same_as_last_(first_same_as_last),
        stages_(make_stage_solver(*ivp.system, options, work)),
        slopes_(static_cast<std::size_t>(tableau.stages), Vector::Zero(ivp.y0.size())),
        guess_(Vector::Zero(ivp.y0.size())),
        start_(ivp.y0.size()),
        zero_(Vector::Zero(ivp.y0.size())),
        error_weights_(tableau.b) {
    for (std::size_t i = 0; i < tableau.b_embedded.size(); ++i) error_weights_[i] -= tableau.b_embedded[i];
    refresh_pointers();
  }

  Status step(double t, double h, VectorRef y) override {
    if (Status status = solve_stages(t, h, y); !status.ok()) return status;
    combine(y, h, tableau_.b, slopes_.size(), y);
    accept();
    return {};
  }

  Status attempt(double t, double h, ConstVectorRef y, VectorRef y_new, VectorRef error) override {
    if (Status status = solve_stages(t, h, y); !status.ok()) return status;
    combine(y, h, tableau_.b, slopes_.size(), y_new);
    combine(zero_, h, error_weights_, slopes_.size(), error);
    const double gamma = tableau_.A(tableau_.stages - 1, tableau_.stages - 1);
    return gamma == 0.0 ? Status{} : stages_->filter(h * gamma, error);
  }

  void accept() override {
    guess_ = slopes_.back();
    has_first_slope_ = false;
    if (!first_same_as_last_) return;
    slopes_.front().swap(slopes_.back());
    refresh_pointers();
    has_first_slope_ = true;
  }

  void restart(double, ConstVectorRef) override {
    guess_.setZero();
    has_first_slope_ = false;
    stages_->forget_matrix();
  }
  void serialise(StateArchive& archive) override {
    archive.visit("first slope", slopes_.front());
    archive.visit("first slope is known", has_first_slope_);
    archive.visit("last slope", guess_);
    stages_->serialise(archive);
  }

 private:
  Status solve_stages(double t, double h, ConstVectorRef y) {
    const auto s = static_cast<std::size_t>(tableau_.stages);
    for (std::size_t i = 0; i < s; ++i) {
      const double gamma = tableau_.a[i * s + i];
      const double time = t + tableau_.c[i] * h;
      if (i == 0 && gamma == 0.0) {
        if (!has_first_slope_) stages_->slope(time, y, slopes_[0]);
        has_first_slope_ = true;  // a repeated attempt starts from the same (t, y)
        continue;
      }
      combine(y, h, {&tableau_.a[i * s], i}, i, start_);
      if (gamma == 0.0) {
        stages_->slope(time, start_, slopes_[i]);
        continue;
      }
      slopes_[i] = i == 0 ? guess_ : slopes_[i - 1];
      if (Status status = stages_->solve(time, h * gamma, start_, slopes_[i]); !status.ok()) return status;
    }
    return {};
  }

  void combine(ConstVectorRef base, double h, std::span<const double> weights, std::size_t count,
               VectorRef out) {
    linear_combination<double>(base.data(), h, weights.data(), pointers_.data(), count, out.data(),
                               static_cast<std::size_t>(out.size()));
  }

  void refresh_pointers() {
    pointers_.clear();
    for (const Vector& slope : slopes_) pointers_.push_back(slope.data());
  }

  TableauValues<double> tableau_;
  bool first_same_as_last_;
  std::unique_ptr<StageSolver> stages_;
  std::vector<Vector> slopes_;
  std::vector<const double*> pointers_{};
  Vector guess_;  ///< the last slope of the step before
  Vector start_, zero_;
  std::vector<double> error_weights_;
  bool has_first_slope_ = false;  ///< slopes_.front() is f at the start of the step to come
};

}  // namespace

std::unique_ptr<Integrator> make_diagonally_implicit_runge_kutta(const ButcherTableau& tableau,
                                                                 const ImplicitOptions& options,
                                                                 const ControllerOptions& controller) {
  if (shape(tableau) != schemes::TableauShape::diagonal_implicit) {
    throw std::logic_error("tableau \"" + tableau.name + "\" is not diagonally implicit");
  }
  const TableauValues<double> values = schemes::values<double>(tableau);
  const bool first_same_as_last = is_first_same_as_last(schemes::values<Float128>(tableau));
  MethodInfo info = tableau_info(tableau, "diagonally implicit Runge-Kutta");
  info.stages = tableau.stages() - (first_same_as_last ? 1 : 0);
  info.formula = tableau.stages() == 1 && values.c[0] == 1.0
                     ? "y' = y + h f(t+h, y')"
                     : "k_i = f(t + c_i h, y + h sum_{j<=i} a_ij k_j);  y' = y + h sum_i b_i k_i";
  const auto make = [=](const Ivp& ivp, Work& work) {
    return std::make_unique<DiagonallyImplicitStepper>(values, first_same_as_last, options, ivp, work);
  };
  if (tableau.b_embedded.empty()) {
    return std::make_unique<FixedStepIntegrator>(
        std::move(info),
        [make](const Ivp& ivp, double, Work& work) -> std::unique_ptr<Stepper> { return make(ivp, work); },
        make_extended_runge_kutta(tableau));
  }
  return std::make_unique<AdaptiveIntegrator>(
      std::move(info), controller,
      [make](const Ivp& ivp, Work& work) -> std::unique_ptr<AdaptiveStepper> { return make(ivp, work); },
      make_extended_runge_kutta(tableau));
}

}  // namespace fw::integrators
