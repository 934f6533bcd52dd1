#pragma once

#include <vector>

#include "schemes/additive_tableau.hpp"

namespace fw::schemes {

/// Additive (implicit–explicit) Runge–Kutta methods.
const std::vector<AdditiveTableau>& additive_tableaus();

}  // namespace fw::schemes
