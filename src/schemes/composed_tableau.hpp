#pragma once

#include "schemes/butcher_tableau.hpp"

namespace fw::schemes {

/// `count` ≥ 1 steps h/count of a method as one step h of a method with count·s stages [Hairer, Nørsett,
/// Wanner 1993, II.12]: what a code does that estimates its error by step doubling and goes on with the half
/// steps. Without embedded solution and dense output.
ButcherTableau repeated(const ButcherTableau& tableau, int count);

}  // namespace fw::schemes
