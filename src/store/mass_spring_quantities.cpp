#include "store/mass_spring_quantities.hpp"

#include <algorithm>

namespace fw::store {

FrameQuantities quantities_of(const mechanics::MassSpringSystem& system) {
  const Vector rest = Vector::Zero(system.degrees_of_freedom());
  FrameQuantities quantities;
  const auto add = [&](std::string_view name, std::string_view unit, int components) {
    quantities.list.push_back({std::string(name), std::string(unit), components});
  };
  for (const NamedValue& energy : system.energies(rest, rest).list()) {
    add(std::string(energy.name) + "_energy", energy.unit, 1);
    if (energy.name != "kinetic") continue;
    add("potential_energy", energy.unit, 1);
    add("total_energy", energy.unit, 1);
  }
  add("linear_momentum", "kg*m/s", 3);
  add("angular_momentum", "kg*m^2/s", 3);
  if (system.is_driven()) {
    add("external_power", "W", 1);
    add("dissipated_power", "W", 1);
  }
  quantities.evaluate = [&system](double t, ConstVectorRef q, ConstVectorRef v, std::span<double> values) {
    const Energies energies = system.energies(t, q, v);
    auto next = values.begin();
    for (const NamedValue& energy : energies.list()) {
      *next++ = energy.value;
      if (energy.name != "kinetic") continue;
      *next++ = energies.potential();
      *next++ = energies.total();
    }
    for (const Vec3<double>& momentum : {system.linear_momentum(v), system.angular_momentum(q, v)}) {
      next = std::ranges::copy(std::array{momentum.x, momentum.y, momentum.z}, next).out;
    }
    if (!system.is_driven()) return;
    *next++ = system.external_power(t, q, v);
    *next++ = system.dissipated_power(t, q, v);
  };
  return quantities;
}

}  // namespace fw::store
