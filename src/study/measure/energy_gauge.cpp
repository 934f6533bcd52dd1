#include "study/measure/energy_gauge.hpp"

#include <fmt/format.h>

namespace fw::study {

EnergyGauge::EnergyGauge(const Problem& problem)
    : springs_(dynamic_cast<const mechanics::MassSpringSystem*>(problem.ivp.system.get())),
      system_(problem.ivp.system->second_order()),
      problem_(&problem) {
  const bool has_energy =
      springs_ != nullptr || (!problem.invariants.empty() && problem.invariants.front().unit == "J");
  if (!has_energy) system_ = nullptr;
}

void EnergyGauge::add(double t, ConstVectorRef y, EnergyBudget& budget) const {
  const Index n = system_->degrees_of_freedom();
  const auto q = y.head(n), v = y.tail(n);
  if (springs_ != nullptr) {
    budget.add(springs_->energies(q, v));
  } else {
    const double kinetic = 0.5 * system_->mass().dot(v.cwiseAbs2());
    budget.add(kinetic, 0.0, problem_->invariants.front().value(t, y) - kinetic);
  }
}

void EnergyWatch::frame(double time, ConstVectorRef state) {
  if (gauge_.is_known()) gauge_.add(time, state, budget_);
  next_.frame(time, state);
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
