#pragma once

#include <string>
#include <vector>

#include "schemes/nystrom_tableau.hpp"

namespace fw::schemes {

/// A composition of drifts q += a_i h v and kicks v += b_i h M⁻¹f(t_i, q, ·), in the order a_1, b_1, a_2,
/// b_2, …, b_s, a_{s+1}; t_i = t + h Σ_{j≤i} a_j. An explicit symplectic scheme for forces f(t, q) [Hairer,
/// Lubich, Wanner 2006, II.5; McLachlan 1995].
///
/// Where f depends on v, kick i is v' = v + b_i h M⁻¹f(t_i, q, v + α_i h M⁻¹f), an implicit stage with
///   α_1 = a_1,  β_i = b_i − α_i,  α_{i+1} = a_{i+1} − β_i.
/// That is the composition of χ_{α_i h} (drift, then implicit kick) with its adjoint χ*_{β_i h} (explicit
/// kick, then drift), which has the order of the splitting for every f [McLachlan 1995, theorem 1; HLW
/// III.3.3], unless the coefficients rest on the commutator [b,[b,[b,a]]] = 0 (schemes of Nyström type).
struct SplittingScheme {
  std::string name{};
  std::string title{};
  CoefficientRow drift{};  ///< a_1 … a_{s+1}
  CoefficientRow kick{};   ///< b_1 … b_s
  std::string reference{};
};

/// α_i of the implicit kicks.
std::vector<Float128> implicit_parts(const SplittingScheme& scheme);

/// The same scheme as a Runge–Kutta–Nyström method (with the implicit stages above), for its order
/// conditions.
NystromValues<Float128> as_nystrom(const SplittingScheme& scheme);

/// See `uncertainty(const ButcherTableau&)`.
double uncertainty(const SplittingScheme& scheme);

}  // namespace fw::schemes
