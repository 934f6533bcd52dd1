#pragma once

#include "ode/integrator.hpp"

namespace fw::benchmarks {

/// One run of PETSc's TS of type "rk", subtype "5dp" (the Dormand–Prince 5(4) pair), with PETSc's default
/// step control ("basic", 2-norm) and the last step made to end at t₁. The right-hand side is
/// `OdeSystem::rhs` on PETSc's own arrays, so nothing is copied. `step_control.initial_step` > 0 is PETSc's
/// first step. Throws SystemError where PETSc reports an error.
Solution solve_by_petsc_5dp(const Ivp& ivp, const AdaptiveStep& step_control);

}  // namespace fw::benchmarks
