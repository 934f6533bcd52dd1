#pragma once

#include <memory>

#include "integrators/butcher_tableau.hpp"
#include "ode/integrator.hpp"

namespace fw::integrators {

/// Explicit Runge–Kutta with constant steps, given by its tableau. Throws std::logic_error if the tableau is
/// not explicit.
std::unique_ptr<Integrator> make_explicit_runge_kutta(const ButcherTableau& tableau);

}  // namespace fw::integrators
