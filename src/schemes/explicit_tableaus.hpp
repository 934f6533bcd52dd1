#pragma once

#include <vector>

#include "schemes/butcher_tableau.hpp"

namespace fw::schemes {

/// Every explicit Runge–Kutta method of the catalogue, by ascending order; the ones of order 6 and more come
/// from `high_order_explicit_tableaus`.
const std::vector<ButcherTableau>& explicit_tableaus();

}  // namespace fw::schemes
