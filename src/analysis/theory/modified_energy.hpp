#pragma once

#include <functional>
#include <string>

#include "ode/ivp.hpp"

namespace fw::analysis {

/// The quantity that a symplectic scheme keeps in place of the energy.
using ModifiedEnergy = std::function<double(double t, ConstVectorRef y)>;

/// Whether f(t, q, v) = K q with a constant symmetric K, as three states tell to rounding.
bool is_linear_oscillation(const OdeSystem& system);

/// The modified energy of the scheme called `method` with steps h on such a system, in closed form; empty
/// where none is known. With the energy H = ½ vᵀMv + V(q) and f = −∇V:
///  - velocity Verlet and the two-step Verlet scheme: H − h²/8 fᵀM⁻¹f,
///  - symplectic Euler (v first, as in [Zachmann 2011, S9]): H + h/2 fᵀv.
/// Both are exact invariants of the scheme on linear systems [Hairer, Lubich, Wanner 2006, I.1.3, IX.3]: on
/// an oscillator ½ m (v² + ω²(1 − h²ω²/4) q²) and ½ m (v² + ω²q² − hω² q v).
ModifiedEnergy modified_energy(const std::string& method, const Ivp& ivp, double h,
                               std::function<double(double t, ConstVectorRef y)> energy);

}  // namespace fw::analysis
