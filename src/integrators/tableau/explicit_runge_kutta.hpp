#pragma once

#include <memory>

#include "integrators/loop/step_size_controller.hpp"
#include "ode/integrator.hpp"
#include "schemes/butcher_tableau.hpp"

namespace fw::integrators {

/// Explicit Runge–Kutta, given by its tableau: constant steps and, where the tableau has an embedded
/// solution, steps chosen by the error estimate. Throws std::logic_error if the tableau is not explicit.
std::unique_ptr<Integrator> make_explicit_runge_kutta(const schemes::ButcherTableau& tableau,
                                                      const ControllerOptions& controller = {});

}  // namespace fw::integrators
