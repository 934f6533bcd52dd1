#include "integrators/tableau/additive_runge_kutta.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "integrators/loop/adaptive_integrator.hpp"
#include "integrators/loop/stepper.hpp"
#include "integrators/tableau/linear_combination.hpp"
#include "schemes/order_conditions.hpp"

namespace fw::integrators {

namespace {

using schemes::AdditiveTableau;
using schemes::TableauShape;
using schemes::TableauValues;

/// Both tableaus; stages of a part whose slope enters nothing are not evaluated.
struct Parts {
  TableauValues<double> stiff{}, soft{};
  std::vector<char> needs_stiff{}, needs_soft{};

  std::size_t stages() const { return static_cast<std::size_t>(stiff.stages); }
};

std::vector<char> needed_stages(const TableauValues<double>& values) {
  const auto s = static_cast<std::size_t>(values.stages);
  std::vector<char> needed(s, 0);
  for (std::size_t j = 0; j < s; ++j) {
    bool is_needed = values.b[j] != 0.0 || (!values.b_embedded.empty() && values.b_embedded[j] != 0.0);
    for (std::size_t i = 0; i < s; ++i) is_needed = is_needed || values.a[i * s + j] != 0.0;
    needed[j] = is_needed ? 1 : 0;
  }
  return needed;
}

class AdditiveStepper final : public AdaptiveStepper {
 public:
  AdditiveStepper(const Parts& parts, const ImplicitOptions& options, const Ivp& ivp, Work& work)
      : parts_(parts),
        system_(*ivp.system->second_order()),
        splitting_(*system_.force_splitting()),
        work_(work),
        stages_(make_stiff_stage_solver(system_, splitting_, options, work)),
        stiff_(parts.stages(), Vector::Zero(ivp.y0.size())),
        soft_(parts.stages(), Vector::Zero(ivp.y0.size())),
        start_(ivp.y0.size()),
        force_(ivp.y0.size() / 2),
        zero_(Vector::Zero(ivp.y0.size())) {
    for (std::size_t i = 0; i < parts.stages(); ++i) {
      stiff_pointers_.push_back(stiff_[i].data());
      soft_pointers_.push_back(soft_[i].data());
    }
    if (parts.stiff.b_embedded.empty()) return;
    for (std::size_t i = 0; i < parts.stages(); ++i) {
      stiff_error_.push_back(parts.stiff.b[i] - parts.stiff.b_embedded[i]);
      soft_error_.push_back(parts.soft.b[i] - parts.soft.b_embedded[i]);
    }
  }

  Status step(double t, double h, VectorRef y) override {
    if (Status status = solve_stages(t, h, y); !status.ok()) return status;
    combine(y, h, parts_.stiff.b.data(), parts_.soft.b.data(), parts_.stages(), y);
    return {};
  }

  Status attempt(double t, double h, ConstVectorRef y, VectorRef y_new, VectorRef error) override {
    if (Status status = solve_stages(t, h, y); !status.ok()) return status;
    combine(y, h, parts_.stiff.b.data(), parts_.soft.b.data(), parts_.stages(), y_new);
    combine(zero_, h, stiff_error_.data(), soft_error_.data(), parts_.stages(), error);
    return stages_->filter(h * parts_.stiff.a.back(), error);
  }

  void restart(double, ConstVectorRef) override {
    for (Vector& slope : stiff_) slope.setZero();
    for (Vector& slope : soft_) slope.setZero();
    stages_->forget_matrix();
  }
  void serialise(StateArchive& archive) override {
    archive.visit("stiff slopes", stiff_);
    archive.visit("soft slopes", soft_);
    stages_->serialise(archive);
  }

  void accept() override {}

 private:
  Status solve_stages(double t, double h, ConstVectorRef y) {
    const std::size_t s = parts_.stages();
    for (std::size_t i = 0; i < s; ++i) {
      const double gamma = parts_.stiff.a[i * s + i];
      const double time = t + parts_.stiff.c[i] * h;
      combine(y, h, &parts_.stiff.a[i * s], &parts_.soft.a[i * s], i, start_);
      if (gamma != 0.0) {
        stiff_[i] = stiff_[i == 0 ? s - 1 : i - 1];
        if (Status status = stages_->solve(time, h * gamma, start_, stiff_[i]); !status.ok()) return status;
        start_ += (h * gamma) * stiff_[i];
      } else if (parts_.needs_stiff[i] != 0) {
        stages_->slope(time, start_, stiff_[i]);
      }
      if (parts_.needs_soft[i] != 0) evaluate_soft(time, i);
    }
    return {};
  }

  /// (0, M⁻¹f_soft) at the stage's state, which is in `start_`.
  void evaluate_soft(double t, std::size_t i) {
    const Index n = force_.size();
    splitting_.soft_force(t, start_.head(n), start_.tail(n), force_);
    ++work_.rhs_evaluations;
    soft_[i].tail(n) = force_.cwiseQuotient(system_.mass());
  }

  void combine(ConstVectorRef base, double h, const double* stiff, const double* soft, std::size_t count,
               VectorRef out) {
    const auto size = static_cast<std::size_t>(out.size());
    linear_combination<double>(base.data(), h, stiff, stiff_pointers_.data(), count, out.data(), size);
    linear_combination<double>(out.data(), h, soft, soft_pointers_.data(), count, out.data(), size);
  }

  const Parts parts_;
  const SecondOrderSystem& system_;
  const ForceSplitting& splitting_;
  Work& work_;
  std::unique_ptr<StageSolver> stages_;
  std::vector<Vector> stiff_, soft_;  ///< slopes of each part
  std::vector<const double*> stiff_pointers_{}, soft_pointers_{};
  std::vector<double> stiff_error_{}, soft_error_{};
  Vector start_, force_, zero_;
};

}  // namespace

std::unique_ptr<Integrator> make_additive_runge_kutta(const AdditiveTableau& tableau,
                                                      const ImplicitOptions& options,
                                                      const ControllerOptions& controller) {
  if (shape(tableau.explicit_part) != TableauShape::explicit_stages ||
      shape(tableau.implicit_part) != TableauShape::diagonal_implicit ||
      tableau.explicit_part.stages() != tableau.implicit_part.stages()) {
    throw std::logic_error("tableau \"" + tableau.name +
                           "\": expected an explicit and a diagonally implicit part");
  }
  schemes::check_tableau(tableau.explicit_part);
  schemes::check_tableau(tableau.implicit_part);
  Parts parts{.stiff = schemes::values<double>(tableau.implicit_part),
              .soft = schemes::values<double>(tableau.explicit_part)};
  parts.needs_stiff = needed_stages(parts.stiff);
  parts.needs_soft = needed_stages(parts.soft);
  MethodInfo info{.name = tableau.name,
                  .title = tableau.title,
                  .family = "additive Runge-Kutta",
                  .reference = tableau.reference};
  info.order = info.order_with_velocity_forces = schemes::order_of_accuracy(tableau);
  info.embedded_order = schemes::embedded_order(tableau);
  info.is_adaptive = !tableau.explicit_part.b_embedded.empty() && !tableau.implicit_part.b_embedded.empty();
  info.stages = tableau.stages();
  info.is_explicit = false;
  info.needs = {Capability::second_order, Capability::force_splitting};
  info.formula =
      "y_i = y + h sum_{j<=i} a_ij f_stiff(y_j) + h sum_{j<i} e_ij f_soft(y_j);  "
      "y' = y + h sum_i b_i f_stiff(y_i) + h sum_i d_i f_soft(y_i)";
  const auto make = [=](const Ivp& ivp, Work& work) {
    return std::make_unique<AdditiveStepper>(parts, options, ivp, work);
  };
  if (!info.is_adaptive) {
    return std::make_unique<FixedStepIntegrator>(
        std::move(info),
        [make](const Ivp& ivp, double, Work& work) -> std::unique_ptr<Stepper> { return make(ivp, work); });
  }
  return std::make_unique<AdaptiveIntegrator>(
      std::move(info), controller,
      [make](const Ivp& ivp, Work& work) -> std::unique_ptr<AdaptiveStepper> { return make(ivp, work); });
}

}  // namespace fw::integrators
