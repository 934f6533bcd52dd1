#pragma once

#include <vector>

#include "core/status.hpp"
#include "ode/ode_system.hpp"

namespace fw::analysis {

/// A vibration z̈ = −ω² z − c ż: what a damped mass-spring system is in each of its modes.
struct VibrationMode {
  double omega_squared = 0.0;  ///< ω² [1/s²]
  double damping = 0.0;        ///< c = 2δ [1/s]
};

/// A system at one state as linear stability sees it: ẏ = J y, or z̈ = −W z − C ż in the coordinates
/// z = M^{1/2} q of the moving degrees of freedom with W = −M^{−1/2} K M^{−1/2}, C = −M^{−1/2} D M^{−1/2}.
struct LinearModes {
  /// Of J [1/s]; unstable (Re λ > 0: compressed springs buckle) and zero modes are excluded: they do not
  /// limit the step size.
  std::vector<Complex> eigenvalues{};
  /// Of a second-order system; modes that grow or rest are left out.
  std::vector<VibrationMode> vibrations{};
  /// The displacement q of each of these, all degrees of freedom; empty for first-order and large systems.
  std::vector<Vector> shapes{};
  /// The largest entry of C between two different modes of W, relative to its largest entry: 0 where the
  /// modes do not exchange energy (proportional damping), and `vibrations` is exact.
  double coupling = 0.0;
  double spectral_radius = 0.0;  ///< largest |λ| [1/s]
  int growing = 0;               ///< eigenvalues with Re λ > 0
  bool is_undamped = false;      ///< there is an eigenvalue on the imaginary axis other than 0
  bool is_complete = true;       ///< false: the largest eigenvalues only
  /// W and C; empty for first-order and for large systems.
  Matrix stiffness{}, damping{};
  bool is_rough = false;  ///< eigenvalues are known to about a hundredth
  Status status{};        ///< of the eigenvalue solver
};

/// All eigenvalues where the system has at most `largest_dense` unknowns, else the six largest in modulus by
/// SLEPc (of an undamped system: the largest frequency). The damping of a large system is taken mode by mode.
LinearModes linear_modes(const OdeSystem& system, double t, ConstVectorRef y, Index largest_dense);

/// The stiffest and the most damped mode of a large system, without a matrix: the largest eigenvalues of
/// −M^{−1/2} K M^{−1/2} and −M^{−1/2} D M^{−1/2} by Krylov spaces, each known to about a hundredth, with the
/// Rayleigh quotient of the other on its vector. Costs a few dozen tangent products.
LinearModes stiffest_modes(const SecondOrderSystem& system, double t, ConstVectorRef y);

/// Whether J is the same, within 1e-10 of its largest entry, at three states about y and two later times.
bool is_linear(const OdeSystem& system, double t, ConstVectorRef y);

}  // namespace fw::analysis
