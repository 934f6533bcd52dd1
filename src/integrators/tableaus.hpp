#pragma once

#include <vector>

#include "integrators/butcher_tableau.hpp"

namespace fw::integrators {

/// Every Runge–Kutta tableau of the catalogue, checked.
const std::vector<ButcherTableau>& tableaus();

}  // namespace fw::integrators
