#pragma once

#include "study/plan.hpp"

namespace fw::study {

/// A study of another kind at every point of a grid of parameters: keys of its specification that take
/// several values. The cases are those of all points, with the parameters as columns of the summary. `kinds`
/// are what [study] may be.
StudyKind sweep_kind(std::vector<StudyKind> kinds);

}  // namespace fw::study
