#pragma once

#include "mechanics/mass_spring_system.hpp"
#include "store/trajectory_writer.hpp"

namespace fw::store {

/// The stored quantities of a mass-spring system, which must outlive the writer: each of its energies as
/// `<name>_energy`, the sums `potential_energy` and `total_energy` after the kinetic one, and the momenta; with forces or
/// supports that depend on time also `external_power` and `dissipated_power` [W], whose balance is
/// d(total_energy)/dt = external_power − dissipated_power.
FrameQuantities quantities_of(const mechanics::MassSpringSystem& system);

}  // namespace fw::store
