#pragma once

#include <vector>

#include "schemes/butcher_tableau.hpp"

namespace fw::schemes {

/// The explicit Runge–Kutta methods of order 6 and more; part of `explicit_tableaus`, which checks them.
const std::vector<ButcherTableau>& high_order_explicit_tableaus();

}  // namespace fw::schemes
