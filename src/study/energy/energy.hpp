#pragma once

#include "study/plan.hpp"

namespace fw::study {

/// The study kind "energy": drift and oscillation of the energy over long runs, modified energies, momenta
/// and the dampers' work, for every method on every problem at several steps. See docs/studies/energy.md.
StudyKind energy_kind();

}  // namespace fw::study
