#pragma once

#include <memory>
#include <vector>

#include "integrators/loop/stepper.hpp"

namespace fw::integrators {

/// One-step schemes of high order that give a multistep scheme its first values. They are run a few times
/// only, so they are chosen for their simplicity: extrapolation tables (Aitken–Neville) over a basic scheme.

/// The explicit midpoint rule with 2, 4, 6, … substeps, extrapolated in h²: order ≥ `order`
/// [Gragg 1965; Hairer, Nørsett, Wanner 1993, II.9].
std::unique_ptr<Stepper> make_explicit_starting_steps(const Ivp& ivp, int order, Work& work);

/// Implicit Euler with 1, 2, 3, … substeps, each solved to convergence, extrapolated in h: order `order`. It
/// damps what is stiff, as the scheme that it starts [Deuflhard 1985; Hairer, Wanner 1996, IV.9].
std::unique_ptr<Stepper> make_implicit_starting_steps(const Ivp& ivp, int order, Work& work);

/// One step of either in binary128, implicit Euler by fixed-point iteration (for problems that are not
/// stiff).
void extended_starting_step(const OdeSystem& system, bool is_explicit, int order, const Float128& t,
                            const Float128& h, std::vector<Float128>& y);

/// Solves y = known + weight f(t, y) in binary128 by fixed-point iteration from the guess y; slope = f(t, y).
void extended_fixed_point(const OdeSystem& system, const Float128& t, const std::vector<Float128>& known,
                          const Float128& weight, std::vector<Float128>& y, std::vector<Float128>& slope);

}  // namespace fw::integrators
