#pragma once

#include <memory>

#include "integrators/implicit/stage_solver.hpp"
#include "integrators/loop/step_size_controller.hpp"
#include "ode/integrator.hpp"
#include "schemes/additive_tableau.hpp"

namespace fw::integrators {

/// Additive (implicit–explicit) Runge–Kutta on systems whose forces come in a stiff and a soft part: (v,
/// M⁻¹f_stiff) is treated by the diagonally implicit tableau, (0, M⁻¹f_soft) by the explicit one [Kennedy,
/// Carpenter 2003]. The matrix M − hγD − (hγ)²K has the stiff derivatives only. An evaluation of either part
/// counts as one force.
///
/// Where the tableaus have an embedded solution, steps can be chosen; the error estimate is filtered as in
/// `make_diagonally_implicit_runge_kutta`.
std::unique_ptr<Integrator> make_additive_runge_kutta(const schemes::AdditiveTableau& tableau,
                                                      const ImplicitOptions& options = {},
                                                      const ControllerOptions& controller = {});

}  // namespace fw::integrators
