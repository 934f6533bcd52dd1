#include "ode/energy_budget.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fw {

void EnergyBudget::add(const Energies& energies) {
  double at_rest_zero = 0.0;
  const double outer = energies["gravitational"];
  for (const NamedValue& energy : energies.list().subspan(1)) {
    if (energy.name != "gravitational") at_rest_zero += energy.value;
  }
  add(energies.kinetic(), at_rest_zero, outer);
}

void EnergyBudget::add(double kinetic, double at_rest_zero, double outer) {
  const double total = kinetic + at_rest_zero + outer;
  if (states_++ == 0) {
    start_ = total;
    outer_start_ = outer;
  }
  change_ = total - start_;
  gain_ = std::max(gain_, change_ - work_);
  const double stored = kinetic + std::abs(at_rest_zero);
  scale_ = std::max(scale_, stored + std::abs(outer - outer_start_));
  sum_ = std::max(sum_, stored + std::abs(outer));
}

void EnergyBudget::add_rounding(double virial, double jitter) {
  virial_ = std::max(virial_, virial);
  jitter_ = std::max(jitter_, jitter);
}

double EnergyBudget::growth_factor() const {
  if (gain_ <= 0.0) return 1.0;
  const double before = scale_ - gain_;
  return before > 0.0 ? scale_ / before : std::numeric_limits<double>::infinity();
}

bool EnergyBudget::has_exploded() const {
  constexpr double share = 0.99;
  // One step of explicit Euler from rest gains all that there is and tells nothing; n of them gain 1/(2n − 1).
  constexpr std::uint64_t one_step = 2;
  // A system at rest gains what rounding leaves: jitter that adds up for a while.
  constexpr double rounding = 1e-9, added_up = 1e6;
  return states_ > one_step && gain_ > rounding * magnitude() + added_up * jitter_ && gain_ >= share * scale_;
}

}  // namespace fw
