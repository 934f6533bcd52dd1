#pragma once

#include "ode/ode_system.hpp"

namespace fw::analysis {

/// How stiff ẏ = f(t, y) is at a state, by the eigenvalues λ of its Jacobian. Eigenvalues below 1e-8 of the
/// largest in modulus count as zero and are left out of the quotients.
struct StiffnessMeasures {
  double largest_eigenvalue = 0.0;  ///< max |λ| [1/s]
  /// max |Re λ|/min |Re λ| over the eigenvalues with Re λ < 0 [Lambert 1991, 6.2]; NaN where there are none,
  /// as without damping.
  double stiffness_ratio = 0.0;
  double eigenvalue_ratio = 0.0;  ///< max |λ|/min |λ|: the spread of time scales, also without damping
};

/// max |λ| of the Jacobian alone [1/s]: by a dense solver up to 200 unknowns, beyond by a Krylov iteration to
/// 1e-4; NaN where that does not converge.
double spectral_radius(const OdeSystem& system, double t, ConstVectorRef y);

/// By a dense eigenvalue solver, O(N³).
StiffnessMeasures stiffness_measures(const OdeSystem& system, double t, ConstVectorRef y);

}  // namespace fw::analysis
