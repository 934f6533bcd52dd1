#pragma once

#include <vector>

#include "schemes/butcher_tableau.hpp"

namespace fw::schemes {

/// A Runge–Kutta–Chebyshev method as its three-term recurrence [Sommeijer, Shampine, Verwer 1998]:
///   Y_1 = y + μ̃_1 h f_0,
///   Y_j = (1 − μ_j − ν_j) y + μ_j Y_{j−1} + ν_j Y_{j−2} + μ̃_j h f_{j−1} + γ̃_j h f_0,   y' = Y_s,
/// with f_j = f(t + c_j h, Y_j). It is stable on a long piece of the negative real axis, about 2 s² (order 1)
/// or 2 s²/3 (order 2), with a little damping there (ε = 1/20 and 2/13).
template <class S>
struct ChebyshevRecurrence {
  int stages = 0;
  std::vector<S> mu{}, nu{}, mu_tilde{}, gamma_tilde{}, c{};  ///< entry j belongs to Y_j; entry 0 to y itself

  /// Makes room for up to `most_stages` stages, so that `set` does not allocate.
  void reserve(int most_stages);
  /// Order 1 with s ≥ 1 stages or order 2 with s ≥ 2; throws std::logic_error otherwise.
  void set(int order, int s);
};

/// The length of the real stability interval of `set(order, s)`: 2s² − (4/3)εs²  or  (2/3)(s² − 1)(1 −
/// (2/15)ε).
double real_stability_interval(int order, int s);

/// The same method as a Butcher tableau, for what is derived from one.
ButcherTableau chebyshev_tableau(int order, int s);

}  // namespace fw::schemes
