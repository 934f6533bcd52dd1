#pragma once

#include <memory>

#include "integrators/stepper.hpp"

namespace fw::integrators {

/// One-step schemes of high order that give a multistep scheme its first values. They are run a few times
/// only, so they are chosen for their simplicity: extrapolation tables (Aitken–Neville) over a basic scheme.

/// The explicit midpoint rule with 2, 4, 6, … substeps, extrapolated in h²: order ≥ `order`
/// [Gragg 1965; Hairer, Nørsett, Wanner 1993, II.9].
std::unique_ptr<Stepper> make_explicit_starting_steps(const Ivp& ivp, int order, Work& work);

/// Implicit Euler with 1, 2, 3, … substeps, each solved to convergence, extrapolated in h: order `order`. It
/// damps what is stiff, as the scheme that it starts [Deuflhard 1985; Hairer, Wanner 1996, IV.9].
std::unique_ptr<Stepper> make_implicit_starting_steps(const Ivp& ivp, int order, Work& work);

}  // namespace fw::integrators
