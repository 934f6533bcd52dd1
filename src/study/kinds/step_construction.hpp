#pragma once

#include "ode/integrator.hpp"
#include "study/result.hpp"

namespace fw::study {

/// Adds to a result how the first `steps` steps on a scalar equation ẏ = f(t, y) come about, one row per
/// step: both ends, the slope of the step, f at both ends and the exact solutions through them: explicit
/// Euler follows the tangent at the start, implicit Euler arrives with the tangent of the end [Zachmann 2011,
/// S33]. Nothing for 0.
void add_step_construction(const Ivp& ivp, const Integrator& integrator, const StepControl& control,
                           std::int64_t steps, CaseResult& result);

}  // namespace fw::study
