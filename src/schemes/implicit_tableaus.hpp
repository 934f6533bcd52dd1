#pragma once

#include <vector>

#include "schemes/butcher_tableau.hpp"

namespace fw::schemes {

/// Diagonally implicit methods: the classical ones, SDIRK and ESDIRK (with an explicit first stage).
const std::vector<ButcherTableau>& diagonally_implicit_tableaus();

/// Methods whose stages are coupled: Gauss, Radau and Lobatto families.
const std::vector<ButcherTableau>& fully_implicit_tableaus();

/// A quotient of long integers as Kennedy and Carpenter print their irrational coefficients, good to 25
/// digits.
Coefficient quotient(const char* text);

/// The implicit parts of ARK3(2)4L[2]SA, ARK4(3)6L[2]SA and ARK5(4)8L[2]SA [Kennedy, Carpenter 2003], which
/// are methods of their own.
ButcherTableau esdirk3();
ButcherTableau esdirk4();
ButcherTableau esdirk5();

}  // namespace fw::schemes
