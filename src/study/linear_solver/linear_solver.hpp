#pragma once

#include "study/plan.hpp"

namespace fw::study {

/// "linear_solver": the linear systems of implicit steps by every solver: assembly, set-up, solve,
/// iterations, memory and true residual over size, stiffness and step; 60 systems of one simulation from a
/// zero guess, from the last solution, and with the first preconditioner kept; spectrum and condition of
/// small systems. A case is a system and a solver, or a system's spectrum.
StudyKind linear_solver_kind();

}  // namespace fw::study
