#pragma once

#include <utility>

#include "core/status.hpp"
#include "mechanics/mass_spring_system.hpp"
#include "ode/energy_budget.hpp"
#include "ode/observer.hpp"
#include "problems/problem.hpp"

namespace fw::study {

/// What the energy of a problem is made of, as far as it is known: of a mass-spring system by element, of another
/// second-order system whose first invariant is in joules as kinetic energy and a potential of any zero.
class EnergyGauge {
 public:
  explicit EnergyGauge(const Problem& problem);
  explicit EnergyGauge(const mechanics::MassSpringSystem& springs)
      : springs_(&springs), system_(&springs), problem_(nullptr) {}

  /// Whether there is an energy.
  bool is_known() const { return system_ != nullptr; }
  /// Kinetic and potential energy [J] of a state y = (q, v). Only where `is_known`.
  std::pair<double, double> energies(double t, ConstVectorRef y) const;
  /// Adds the energies of a state y = (q, v). Only where `is_known`.
  void add(double t, ConstVectorRef y, EnergyBudget& budget) const;
  /// Adds what rounding does to a state, for steps of h [s]. Only where `is_known`; costs an evaluation of the forces.
  void add_rounding(double t, ConstVectorRef y, double h, EnergyBudget& budget) const;
  const mechanics::MassSpringSystem* springs() const { return springs_; }

 private:
  const mechanics::MassSpringSystem* springs_ = nullptr;
  const SecondOrderSystem* system_ = nullptr;
  const Problem* problem_ = nullptr;
};

/// How much work forces over time and moving supports have done at most: Σ h max |P|, over the ends and the middle
/// of each step. Nothing where nothing depends on time.
class OuterWork {
 public:
  /// `springs` may be null.
  explicit OuterWork(const mechanics::MassSpringSystem* springs)
      : springs_(springs != nullptr && springs->is_driven() ? springs : nullptr) {}

  bool is_possible() const { return springs_ != nullptr; }
  /// The next state of a run, each one in turn.
  void add(double t, ConstVectorRef y, EnergyBudget& budget);

 private:
  const mechanics::MassSpringSystem* springs_;
  Vector last_, middle_;
  double last_time_ = 0.0, last_power_ = 0.0;
};

/// Keeps the account of a run's energies before it passes the steps on: a run whose energy multiplies from nowhere
/// is no success, however finite its numbers are. Looks at the first 64 steps, every sixteenth and the last: at all of
/// them it would cost as much as an evaluation of the forces per step.
class EnergyWatch final : public Observer {
 public:
  EnergyWatch(EnergyGauge gauge, Observer& next) : gauge_(gauge), work_(gauge.springs()), next_(next) {}

  bool observe(const StepView& view) override;
  /// A state before the first step that is observed: of a run that goes on from a checkpoint.
  void add_earlier(double time, ConstVectorRef state);
  /// `status`, or blow_up with the factor by which the energy has grown.
  Status judged(const Status& status) const;

 private:
  EnergyGauge gauge_;
  OuterWork work_;
  Observer& next_;
  EnergyBudget budget_;
  double start_time_ = 0.0;
};

}  // namespace fw::study
