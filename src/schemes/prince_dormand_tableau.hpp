#pragma once

#include "schemes/butcher_tableau.hpp"

namespace fw::schemes {

/// Prince and Dormand's RK8(7)13M, the formula of order 8 [Prince, Dormand 1981, table 2], which GSL's rk8pd
/// advances by. The printed quotients stand for irrational numbers, to about 18 digits: for what is derived
/// from a tableau, not a scheme of the catalogue.
ButcherTableau prince_dormand_87();

}  // namespace fw::schemes
