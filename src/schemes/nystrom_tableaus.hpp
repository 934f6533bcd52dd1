#pragma once

#include <vector>

#include "schemes/nystrom_tableau.hpp"

namespace fw::schemes {

/// Every explicit Runge–Kutta–Nyström method of the catalogue, by ascending order.
const std::vector<NystromTableau>& nystrom_tableaus();

/// Partitioned pairs with implicit stages, positions by one method and velocities by another, in Nyström
/// form.
const std::vector<NystromTableau>& implicit_nystrom_tableaus();

}  // namespace fw::schemes
