#pragma once

#include "study/plan.hpp"

namespace fw::study {

/// "work_precision": the true error of every method on a ladder of steps or tolerances against what it costs:
/// right-hand sides, Jacobians, factorisations, iterations and seconds; the Pareto front per problem; the
/// efficiency order of constant steps with a verdict. A case is a problem, a method and its step control, or
/// a problem's front. See docs/studies/work_precision.md.
StudyKind work_precision_kind();

}  // namespace fw::study
