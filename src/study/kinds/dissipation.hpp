#pragma once

#include "study/plan.hpp"

namespace fw::study {

/// The study kind "dissipation": numerical damping ratio and period error of every method over ωh, from its
/// coefficients and measured on runs of a spring. See docs/studies/dissipation.md.
StudyKind dissipation_kind();

}  // namespace fw::study
