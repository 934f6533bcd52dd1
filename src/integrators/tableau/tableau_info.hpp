#pragma once

#include <string>

#include "ode/integrator.hpp"
#include "schemes/butcher_tableau.hpp"

namespace fw::integrators {

/// What a Runge–Kutta tableau says of its scheme: names, orders, stability and geometry as they follow from
/// the coefficients. Engines fill in stages and formula.
MethodInfo tableau_info(const schemes::ButcherTableau& tableau, const std::string& family);

}  // namespace fw::integrators
