#pragma once

#include "study/plan.hpp"

namespace fw::study {

/// Regions of linear stability of each method; the largest stable step of each method on each problem, as the
/// spectrum of J predicts it and as runs show it; and how it depends on a parameter of the problem. See
/// docs/studies/stability.md.
StudyKind stability_kind();

}  // namespace fw::study
