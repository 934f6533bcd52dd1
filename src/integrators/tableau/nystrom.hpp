#pragma once

#include <memory>

#include "integrators/loop/step_size_controller.hpp"
#include "ode/integrator.hpp"
#include "schemes/nystrom_tableau.hpp"

namespace fw::integrators {

/// An explicit Runge–Kutta–Nyström method for M q̈ = f(t, q, q̇), given by its tableau: constant steps and,
/// where the tableau has an embedded solution, steps chosen by the error estimate. One force per stage; where
/// the last stage is the new state its force serves the next step. A tableau without coefficients for
/// velocities needs forces f(t, q). Throws std::logic_error if the tableau is not explicit.
std::unique_ptr<Integrator> make_nystrom(const schemes::NystromTableau& tableau,
                                         const ControllerOptions& controller = {});

}  // namespace fw::integrators
