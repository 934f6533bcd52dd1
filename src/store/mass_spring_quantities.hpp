#pragma once

#include "mechanics/mass_spring_system.hpp"
#include "store/trajectory_writer.hpp"

namespace fw::store {

/// The stored quantities of a mass-spring system, which must outlive the writer.
inline QuantitiesOf quantities_of(const mechanics::MassSpringSystem& system) {
  return [&system](double, ConstVectorRef q, ConstVectorRef v) {
    const mechanics::Energies energies = system.energies(q, v);
    return FrameQuantities{.kinetic = energies.kinetic,
                           .elastic = energies.elastic,
                           .gravitational = energies.gravitational,
                           .obstacle = energies.obstacle,
                           .linear_momentum = system.linear_momentum(v),
                           .angular_momentum = system.angular_momentum(q, v)};
  };
}

}  // namespace fw::store
