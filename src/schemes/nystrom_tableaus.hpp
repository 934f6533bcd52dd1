#pragma once

#include <vector>

#include "schemes/nystrom_tableau.hpp"

namespace fw::schemes {

/// Every explicit Runge–Kutta–Nyström method of the catalogue, by rising order.
const std::vector<NystromTableau>& nystrom_tableaus();

}  // namespace fw::schemes
