#pragma once

#include "study/plan.hpp"

namespace fw::study {

/// The study kind "convergence": the observed order of every method on every problem, with a 95 % interval
/// and a verdict. See docs/studies.md for the keys of its specification.
StudyKind convergence_kind();

}  // namespace fw::study
