#pragma once

#include "analysis/theory/linear_scheme.hpp"
#include "analysis/theory/modified_energy.hpp"
#include "analysis/theory/oscillator_amplification.hpp"
#include "schemes/scheme_data.hpp"

namespace fw::analysis {

/// What theory says of a method with the options of one call, apart from its running code. It is given where
/// the method is registered; what is empty is not known.
struct Theory {
  /// The coefficients that define the method.
  schemes::SchemeData coefficients{};
  /// Those of the scheme that it is on forces f(q): velocity Verlet for `verlet`.
  schemes::SchemeData on_position_forces{};
  /// What it is on linear systems, damped or not.
  LinearScheme on_linear_systems{};
  /// The invariant that it keeps in place of the energy on linear oscillations.
  ModifiedEnergyRule modified_energy = nullptr;
};

/// Of a method that is its coefficients.
Theory theory_of(schemes::SchemeData coefficients);

/// Of a method that is another one on every linear system that it applies to, and no more: a scheme of ours
/// whose iteration or average is exact there, or a foreign code whose manual names the table.
Theory theory_on_linear_systems(LinearScheme scheme);

/// The factors by which the method multiplies oscillations q̈ = −ω²q; empty where nothing is known.
AmplificationFactors oscillator_factors(const Theory& theory);

}  // namespace fw::analysis
