#include "study/measure/energy_gauge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fw::study {

EnergyGauge::EnergyGauge(const Problem& problem)
    : springs_(dynamic_cast<const mechanics::MassSpringSystem*>(problem.ivp.system.get())),
      system_(problem.ivp.system->second_order()),
      problem_(&problem) {
  const bool has_energy =
      springs_ != nullptr || (!problem.invariants.empty() && problem.invariants.front().unit == "J");
  if (!has_energy) system_ = nullptr;
}

std::pair<double, double> EnergyGauge::energies(double t, ConstVectorRef y) const {
  const Index n = system_->degrees_of_freedom();
  const auto q = y.head(n), v = y.tail(n);
  if (springs_ != nullptr) {
    const Energies energies = springs_->energies(t, q, v);
    return {energies.kinetic(), energies.potential()};
  }
  const double kinetic = 0.5 * system_->mass().dot(v.cwiseAbs2());
  return {kinetic, problem_->invariants.front().value(t, y) - kinetic};
}

void EnergyGauge::add(double t, ConstVectorRef y, EnergyBudget& budget) const {
  const Index n = system_->degrees_of_freedom();
  if (springs_ != nullptr) {
    budget.add(springs_->energies(t, y.head(n), y.tail(n)));
  } else {
    const auto [kinetic, potential] = energies(t, y);
    budget.add(kinetic, 0.0, potential);
  }
}

void EnergyGauge::add_rounding(double t, ConstVectorRef y, double h, EnergyBudget& budget) const {
  const Index n = system_->degrees_of_freedom();
  const auto q = y.head(n), v = y.tail(n);
  Vector force(n);
  system_->force(t, q, v, force);
  const double digit = std::numeric_limits<double>::epsilon() / h;
  budget.add_rounding(force.cwiseProduct(q).norm(), digit * digit * system_->mass().dot(q.cwiseAbs2()));
}

void OuterWork::add(double t, ConstVectorRef y, EnergyBudget& budget) {
  if (!is_possible()) return;
  const Index n = springs_->degrees_of_freedom();
  const auto power = [&](double time, ConstVectorRef state) {
    return std::abs(springs_->external_power(time, state.head(n), state.tail(n)));
  };
  const double now = power(t, y);
  if (last_.size() > 0) {
    middle_ = 0.5 * (last_ + y);
    budget.add_work((t - last_time_) * std::max({last_power_, power(0.5 * (last_time_ + t), middle_), now}));
  }
  last_ = y;
  last_time_ = t;
  last_power_ = now;
}

bool EnergyWatch::observe(const StepView& view) {
  constexpr std::uint64_t every_one = 64, stride = 16;
  work_.add(view.time, view.state, budget_);
  if (gauge_.is_known() && (view.index < every_one || view.index % stride == 0 || view.last)) {
    gauge_.add(view.time, view.state, budget_);
    if (view.index == 0) start_time_ = view.time;
    if (view.index == 10 ||
        (view.last && view.index > 0)) {  // with the mean step: the last one can be a sliver
      gauge_.add_rounding(view.time, view.state, (view.time - start_time_) / static_cast<double>(view.index),
                          budget_);
    }
  }
  return next_.observe(view);
}

void EnergyWatch::add_earlier(double time, ConstVectorRef state) {
  if (!gauge_.is_known()) return;
  work_.add(time, state, budget_);
  gauge_.add(time, state, budget_);
}

Status EnergyWatch::judged(const Status& status) const {
  if (!status.ok() || !budget_.has_exploded()) return status;
  return {
      StatusCode::blow_up,
      fmt::format(
          "the energy grows by the factor {:.3g} without a source, from {:.3g} J to {:.3g} J: the step is "
          "too long for this method",
          budget_.growth_factor(), budget_.start(), budget_.start() + budget_.gain())};
}

}  // namespace fw::study
