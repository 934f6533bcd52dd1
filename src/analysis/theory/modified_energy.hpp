#pragma once

#include <functional>

#include "ode/ivp.hpp"
#include "schemes/scheme_data.hpp"

namespace fw::analysis {

/// An energy or what takes its place, as a function of time and state.
using EnergyFunction = std::function<double(double t, ConstVectorRef y)>;

/// Makes the quantity that a symplectic scheme with steps h keeps in place of `energy`, in closed form, on a
/// system with forces f(q) = Kq.
using ModifiedEnergyRule = EnergyFunction (*)(const Ivp& ivp, double h, EnergyFunction energy);

/// With the energy H = ½ vᵀMv + V(q) and f = −∇V, exact invariants on linear systems [Hairer, Lubich, Wanner
/// 2006, I.1.3, IX.3]:
///  - of velocity Verlet and the two-step Verlet scheme: H − h²/8 fᵀM⁻¹f,
///  - of symplectic Euler (v first, as in [Zachmann 2011, S9]): H + h/2 fᵀv.
/// On an oscillator ½ m (v² + ω²(1 − h²ω²/4) q²) and ½ m (v² + ω²q² − hω² q v).
EnergyFunction velocity_verlet_energy(const Ivp& ivp, double h, EnergyFunction energy);
EnergyFunction symplectic_euler_energy(const Ivp& ivp, double h, EnergyFunction energy);

/// The rule of a scheme by its coefficients; null where no closed form is known.
ModifiedEnergyRule modified_energy_rule(const schemes::SchemeData& data);

/// Whether f(t, q, v) = K q with a constant symmetric K, as three states tell to rounding.
bool is_linear_oscillation(const OdeSystem& system);

/// The modified energy of a scheme with steps h; empty where there is no rule, and on systems that are no
/// linear oscillation.
EnergyFunction modified_energy(ModifiedEnergyRule rule, const Ivp& ivp, double h, EnergyFunction energy);

}  // namespace fw::analysis
