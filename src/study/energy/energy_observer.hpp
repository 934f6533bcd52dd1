#pragma once

#include <optional>

#include "analysis/fit/binned_series.hpp"
#include "analysis/fit/gregory_quadrature.hpp"
#include "analysis/theory/modified_energy.hpp"
#include "mechanics/mass_spring_system.hpp"
#include "ode/energy_budget.hpp"
#include "study/measure/energy_gauge.hpp"
#include "study/plan.hpp"
#include "study/problem_spec.hpp"

namespace fw::study {

/// What is watched along a run: the first invariant of a problem (its energy), for mass-spring systems the
/// total energy, whether it is conserved or not.
struct WatchedProblem {
  std::string quantity;  ///< "energy", or the invariant's name
  std::string unit;
  std::function<double(double t, ConstVectorRef y)> value;
  EnergyGauge gauge;                                     ///< the parts of `value`, where it is an energy
  const mechanics::MassSpringSystem* springs = nullptr;  ///< null: no mass-spring system
  bool is_damped = false;           ///< energy leaves through dampers, and the power is known
  bool is_driven = false;           ///< forces or supports over time do work, and their power is known
  bool is_free = false;             ///< no outer force: linear and angular momentum are conserved
  bool is_isolated_spring = false;  ///< one frequency ω, see `frequency`
  double frequency = 0.0;           ///< ω of a harmonic oscillator or rotation [1/s]

  const SecondOrderSystem* system = nullptr;  ///< null: no M q̈ = f

  /// Kinetic energy, of other systems than M q̈ = f the square of the state.
  double motion(ConstVectorRef y) const;

  /// Throws InputError where there is nothing to watch.
  explicit WatchedProblem(const StudyProblem& entry);
};

/// Streams one run into bins: memory does not grow with the number of steps.
class EnergyObserver final : public Observer {
 public:
  EnergyObserver(const WatchedProblem& watched, analysis::EnergyFunction modified, double step,
                 std::uint64_t steps, std::uint64_t bins);

  bool observe(const StepView& view) override;

  double start() const { return first_; }  ///< the energy at the start
  /// Sizes of the energies that do not depend on the zero of a potential; of an invariant that is no energy of
  /// its largest modulus.
  const EnergyBudget& budget() const { return budget_; }
  double scale() const { return budget_.scale(); }
  std::uint64_t steps_taken() const { return steps_taken_; }
  const analysis::BinnedSeries& change() const { return change_; }  ///< E_n − E_0
  /// `WatchedProblem::motion`, for its trend.
  const analysis::BinnedSeries& motion() const { return motion_; }
  /// fᵀM⁻¹f [J/s²] of M q̈ = f, of long runs at some of the steps: the energies of fast vibrations weigh more in it
  /// than those of slow ones, as they do in the error of the energy. Empty for other systems.
  const std::optional<analysis::BinnedSeries>& activity() const { return activity_; }
  /// ln(E_n/E_0) over n; empty where the energy is not positive.
  const std::optional<analysis::BinnedSeries>& logarithm() const { return logarithm_; }
  const std::optional<analysis::BinnedSeries>& modified_change() const { return modified_change_; }
  const std::optional<analysis::BinnedSeries>& momentum_change() const { return momentum_change_; }
  const std::optional<analysis::BinnedSeries>& angular_change() const { return angular_change_; }
  double momentum_scale() const { return momentum_scale_; }  ///< the largest Σ m |v| [kg·m/s]
  double angular_scale() const { return angular_scale_; }    ///< the largest Σ |x| m |v| [kg·m²/s]
  /// E_n − E_0 + ∫ (P_dissipated − P_external) dt along the numerical trajectory, at the end of each bin; empty
  /// where there is neither.
  const std::vector<double>& balance() const { return balance_; }
  /// The integral in it [J].
  const std::vector<double>& work() const { return work_; }

 private:
  void watch_momenta(const StepView& view, ConstVectorRef q, ConstVectorRef v);
  void watch_work(const StepView& view, ConstVectorRef q, ConstVectorRef v, double change);
  void watch_motion(const StepView& view);
  void watch_size(const StepView& view, double value);
  bool ends_bin(const StepView& view) const;

  const WatchedProblem& watched_;
  analysis::EnergyFunction modified_;
  double step_;
  std::uint64_t steps_, bins_;
  EnergyBudget budget_;
  OuterWork outer_work_;
  double first_ = 0.0, modified_start_ = 0.0;
  std::uint64_t steps_taken_ = 0;
  analysis::BinnedSeries change_, motion_;
  std::optional<analysis::BinnedSeries> activity_;
  std::uint64_t stride_ = 1;  ///< steps from one value of the activity to the next
  Vector force_;
  std::optional<analysis::BinnedSeries> logarithm_, modified_change_, momentum_change_, angular_change_;
  Vec3<double> momentum_start_{}, angular_start_{};
  double momentum_scale_ = 0.0, angular_scale_ = 0.0;
  analysis::GregoryQuadrature power_;
  std::vector<double> balance_, work_;
};

}  // namespace fw::study
