#pragma once

#include "core/status.hpp"
#include "mechanics/mass_spring_system.hpp"
#include "ode/energy_budget.hpp"
#include "problems/problem.hpp"
#include "record/frame_sink.hpp"

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
  /// Adds the energies of a state y = (q, v). Only where `is_known`.
  void add(double t, ConstVectorRef y, EnergyBudget& budget) const;
  const mechanics::MassSpringSystem* springs() const { return springs_; }
  const SecondOrderSystem* system() const { return system_; }

 private:
  const mechanics::MassSpringSystem* springs_ = nullptr;
  const SecondOrderSystem* system_ = nullptr;
  const Problem* problem_ = nullptr;
};

/// Passes frames on and keeps the account of their energies: a run whose energy multiplies from nowhere is no
/// success, however finite its numbers are.
class EnergyWatch final : public record::FrameSink {
 public:
  EnergyWatch(EnergyGauge gauge, record::FrameSink& next) : gauge_(gauge), next_(next) {}

  void frame(double time, ConstVectorRef state) override;
  /// `status`, or blow_up with the factor by which the energy has grown.
  Status judged(const Status& status) const;

 private:
  EnergyGauge gauge_;
  record::FrameSink& next_;
  EnergyBudget budget_;
};

}  // namespace fw::study
