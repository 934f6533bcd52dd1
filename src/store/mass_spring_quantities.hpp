#pragma once

#include "mechanics/mass_spring_system.hpp"
#include "store/trajectory_writer.hpp"

namespace fw::store {

/// The stored quantities of a mass-spring system, which must outlive the writer: each of its energies as
/// `<name>_energy`, the sums `potential_energy` and `total_energy` after the kinetic one, and the momenta.
FrameQuantities quantities_of(const mechanics::MassSpringSystem& system);

}  // namespace fw::store
