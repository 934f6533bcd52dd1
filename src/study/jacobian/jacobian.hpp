#pragma once

#include "study/plan.hpp"

namespace fw::study {

/// The kind "jacobian": analytic derivatives against complex steps, differences and the lecture's printed
/// formulas (errata E1, E2), the sparsity of the tangent matrices, and what compressed springs do to implicit
/// steps (erratum E5). docs/studies/jacobian.md has the keys.
StudyKind jacobian_kind();

}  // namespace fw::study
