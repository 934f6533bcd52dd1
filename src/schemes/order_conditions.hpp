#pragma once

#include "schemes/additive_tableau.hpp"
#include "schemes/butcher_tableau.hpp"
#include "schemes/nystrom_tableau.hpp"
#include "schemes/rosenbrock_tableau.hpp"
#include "schemes/splitting_scheme.hpp"

namespace fw::schemes {

/// Orders of accuracy by the order conditions of rooted trees, decided up to `highest_order`. A condition holds where
/// its residual is below what the coefficients' uncertainty explains; see docs/methods.md.
inline constexpr int highest_order = 10;

int order_of_accuracy(const ButcherTableau& tableau);
/// Order of b̂; 0 where there is none.
int embedded_order(const ButcherTableau& tableau);
/// For forces f(t, q) with ForceClass position (special Nyström trees), or f(t, q, v) (Nyström trees).
int order_of_accuracy(const NystromTableau& tableau, bool velocity_forces);
int embedded_order(const NystromTableau& tableau);
int order_of_accuracy(const SplittingScheme& scheme, bool velocity_forces);
int order_of_accuracy(const RosenbrockTableau& tableau);
int embedded_order(const RosenbrockTableau& tableau);
int order_of_accuracy(const AdditiveTableau& tableau);
int embedded_order(const AdditiveTableau& tableau);

}  // namespace fw::schemes
