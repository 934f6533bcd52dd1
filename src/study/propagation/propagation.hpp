#pragma once

#include "study/plan.hpp"

namespace fw::study {

/// The study kind "propagation": how many springs a disturbance travels per step of a scheme, and the speed
/// of the physical front. See docs/studies/propagation.md.
StudyKind propagation_kind();

}  // namespace fw::study
