#pragma once

#include <memory>

#include "ode/integrator.hpp"
#include "schemes/multistep_formula.hpp"

namespace fw::integrators {

/// A linear multistep method with constant steps, t_n = t₀ + n h: Σ_j α_j y_{n+j} = h Σ_j β_j f(t_{n+j},
/// y_{n+j}). It refuses intervals that are not a whole number of steps.
///
/// Explicit formulas cost one right-hand side per step. Implicit ones are solved by Newton's iteration to
/// convergence, second-order systems with matrices of half the size; their f_{n+k} is taken from the formula
/// itself, which saves an evaluation and does not amplify Newton's rest. The first k − 1 steps are made by a
/// one-step scheme of the same order (see `starting_steps.hpp`: extrapolated midpoint rule for explicit
/// formulas, extrapolated implicit Euler for implicit ones), whose work is counted too.
std::unique_ptr<Integrator> make_linear_multistep(const schemes::MultistepFormula& formula);

}  // namespace fw::integrators
