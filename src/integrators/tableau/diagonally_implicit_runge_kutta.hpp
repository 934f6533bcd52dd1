#pragma once

#include <memory>

#include "integrators/implicit/stage_solver.hpp"
#include "integrators/loop/step_size_controller.hpp"
#include "ode/integrator.hpp"
#include "schemes/butcher_tableau.hpp"

namespace fw::integrators {

/// Diagonally implicit Runge–Kutta, given by its tableau: one `StageSolver` equation per implicit stage, all
/// with the matrix of I − hγJ where the diagonal is constant. Explicit stages cost a slope, and none where
/// the last stage of the step before was its end (stiffly accurate methods with an explicit first stage).
///
/// Where the tableau has an embedded solution, steps can be chosen by the error estimate
/// (I − hγJ)⁻¹ h Σ_i (b_i − b̂_i) k_i [Hairer, Wanner 1996, IV.8]. Throws std::logic_error unless the tableau
/// is diagonally implicit.
std::unique_ptr<Integrator> make_diagonally_implicit_runge_kutta(const schemes::ButcherTableau& tableau,
                                                                 const ImplicitOptions& options = {},
                                                                 const ControllerOptions& controller = {});

}  // namespace fw::integrators
