#pragma once

#include "study/plan.hpp"

namespace fw::study {

/// The study kind "simulate": trajectories of every method at every step (or tolerance) on every problem,
/// with the exact solution where there is one, and the vector field ẏ = f(t, y) on a grid if asked for. See
/// docs/studies.md.
StudyKind simulate_kind();

}  // namespace fw::study
