#pragma once

#include "ode/ivp.hpp"

namespace fw::problems {

/// The largest |λ| of J(t, y) along the solution of `ivp` [1/s], for dense systems of moderate size.
///
/// The solution is followed by the linearly implicit ode23s scheme at a relative tolerance of 1e-3 (stiffness
/// costs no steps), for at most 5000 steps; the eigenvalues are taken wherever the state has moved by 2 %.
/// That makes the value good to some percent, enough to tell how stiff a problem is.
/// [Shampine, Reichelt 1997, The MATLAB ODE suite, SIAM J. Sci. Comput. 18]
double spectral_radius_along_solution(const Ivp& ivp);

}  // namespace fw::problems
