#include "study/energy/energy_observer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace fw::study {

WatchedProblem::WatchedProblem(const StudyProblem& entry) : gauge(entry.problem), springs(gauge.springs()) {
  const Problem& problem = entry.problem;
  system = problem.ivp.system->second_order();
  if (springs != nullptr) {
    const Index n = springs->degrees_of_freedom();
    quantity = "energy";
    unit = std::string(1, 'J');  // GCC 12 warns wrongly of the assignment of one letter
    value = [s = springs, n](double t, ConstVectorRef y) {
      return s->energies(t, y.head(n), y.tail(n)).total();
    };
    is_damped = springs->force_class() == ForceClass::velocity;
    is_driven = springs->is_driven();
    is_free = springs->model().fixed.empty() && springs->elements().is_internal() && !is_driven;
    return;
  }
  if (problem.invariants.empty()) {
    throw InputError(
        fmt::format("problem \"{}\" has neither an energy nor another invariant; damped systems "
                    "have to be scenes, whose dampers' power is known",
                    entry.label));
  }
  const Invariant& first = problem.invariants.front();
  quantity = first.name;
  unit = first.unit;
  value = first.value;
  is_isolated_spring = problem.test_equation == TestEquation::single_oscillation;
  if (is_isolated_spring) frequency = problem.stiffness();
}

double WatchedProblem::motion(ConstVectorRef y) const {
  if (system == nullptr) return y.squaredNorm();
  return 0.5 * system->mass().dot(y.tail(system->degrees_of_freedom()).cwiseAbs2());
}

EnergyObserver::EnergyObserver(const WatchedProblem& watched, analysis::EnergyFunction modified, double step,
                               std::uint64_t steps, std::uint64_t bins)
    : watched_(watched),
      modified_(std::move(modified)),
      step_(step),
      steps_(steps),
      bins_(std::min(bins, steps + 1)),
      outer_work_(watched.springs),
      change_(steps + 1, bins),
      motion_(steps + 1, bins) {
  const auto series = [&] { return analysis::BinnedSeries(steps + 1, bins); };
  // A force evaluation each is as much as a step of a symplectic scheme costs.
  constexpr std::uint64_t long_run = 16'000, stride = 16;
  if (steps > long_run) stride_ = stride;
  if (watched.system != nullptr) {
    activity_ = analysis::BinnedSeries(steps / stride_ + 1, bins);
    force_.resize(watched.system->degrees_of_freedom());
  }
  if (watched.is_isolated_spring) logarithm_ = series();
  if (modified_) modified_change_ = series();
  if (watched.is_free) {
    momentum_change_ = series();
    angular_change_ = series();
  }
}

bool EnergyObserver::ends_bin(const StepView& view) const {
  const auto bin = [&](std::uint64_t index) {
    return static_cast<std::uint64_t>(static_cast<__uint128_t>(index) * bins_ / (steps_ + 1));
  };
  return view.last || bin(view.index) != bin(view.index + 1);
}

void EnergyObserver::watch_size(const StepView& view, double value) {
  if (!watched_.gauge.is_known()) {
    budget_.add(0.0, value, 0.0);
    return;
  }
  outer_work_.add(view.time, view.state, budget_);
  watched_.gauge.add(view.time, view.state, budget_);
  if (view.index != 0 && !ends_bin(view)) return;
  watched_.gauge.add_rounding(view.time, view.state, step_, budget_);
}

bool EnergyObserver::observe(const StepView& view) {
  const double energy = watched_.value(view.time, view.state);
  if (!std::isfinite(energy)) return false;
  watch_size(view, energy);
  if (view.index == 0) {
    first_ = energy;
    if (modified_) modified_start_ = modified_(view.time, view.state);
  }
  steps_taken_ = view.index;
  const double change = energy - first_;
  change_.add(view.time, change);
  watch_motion(view);
  // What has decayed so far says nothing more: squares of it leave the range of doubles.
  constexpr double decayed = 1e-100;
  if (logarithm_ && energy > decayed * first_)
    logarithm_->add(static_cast<double>(view.index), std::log(energy / first_));
  if (modified_) modified_change_->add(view.time, modified_(view.time, view.state) - modified_start_);
  if (watched_.springs != nullptr) {
    const Index n = watched_.springs->degrees_of_freedom();
    if (watched_.is_free) watch_momenta(view, view.state.head(n), view.state.tail(n));
    if (watched_.is_damped || watched_.is_driven)
      watch_work(view, view.state.head(n), view.state.tail(n), change);
  }
  return true;
}

void EnergyObserver::watch_motion(const StepView& view) {
  motion_.add(view.time, watched_.motion(view.state));
  if (!activity_ || view.index % stride_ != 0) return;
  const Index n = force_.size();
  watched_.system->force(view.time, view.state.head(n), view.state.tail(n), force_);
  double sum = 0.0;
  for (Index i = 0; i < n; ++i) sum += force_[i] * force_[i] / watched_.system->mass()[i];
  activity_->add(view.time, sum);
}

void EnergyObserver::watch_momenta(const StepView& view, ConstVectorRef q, ConstVectorRef v) {
  const mechanics::MassSpringSystem& springs = *watched_.springs;
  const Vec3<double> momentum = springs.linear_momentum(v), angular = springs.angular_momentum(q, v);
  if (view.index == 0) {
    momentum_start_ = momentum;
    angular_start_ = angular;
  }
  double momentum_size = 0.0, angular_size = 0.0;
  for (Index i = 0; i < springs.particle_count(); ++i) {
    const double p = springs.mass()[3 * i] * v.segment<3>(3 * i).norm();
    momentum_size += p;
    angular_size += p * q.segment<3>(3 * i).norm();
  }
  momentum_scale_ = std::max(momentum_scale_, momentum_size);
  angular_scale_ = std::max(angular_scale_, angular_size);
  momentum_change_->add(view.time, norm(momentum - momentum_start_));
  angular_change_->add(view.time, norm(angular - angular_start_));
}

void EnergyObserver::watch_work(const StepView& view, ConstVectorRef q, ConstVectorRef v, double change) {
  const mechanics::MassSpringSystem& springs = *watched_.springs;
  power_.add(springs.dissipated_power(view.time, q, v) - springs.external_power(view.time, q, v));
  // The last value of each bin: where the next one belongs to another bin.
  if (ends_bin(view)) {
    work_.push_back(power_.integral(step_));
    balance_.push_back(change + work_.back());
  }
}

}  // namespace fw::study
