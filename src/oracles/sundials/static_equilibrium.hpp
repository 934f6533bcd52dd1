#pragma once

#include "core/status.hpp"
#include "core/work.hpp"
#include "ode/second_order_system.hpp"
#include "oracles/sundials/vector_operations.hpp"

namespace fw::oracles {

struct EquilibriumOptions {
  /// The largest residual force, as a fraction of the largest force at the start; never below what rounding
  /// leaves of the forces of the single springs.
  double residual_tolerance = 1e-12;
  int maximum_iterations = 500;
  /// K of Newton's matrix. `exact` converges quadratically; the others keep −K semi-definite where springs
  /// are compressed.
  TangentModel tangent = TangentModel::exact;
  /// Newton's matrix is −K + μ I with μ = regularisation · ‖f‖∞/ℓ, ℓ the extent of the start: it is regular
  /// where K is not, as in a horizontal chain at rest length, and vanishes with the residual, so that
  /// convergence stays fast. 0: Newton's own method.
  double regularisation = 1.0;
  VectorOperations vector = VectorOperations::eigen;
};

/// Where all forces vanish, or what came of looking for it.
struct StaticEquilibrium {
  Vector position;        ///< n entries; the last iterate where the search has failed
  double residual = 0.0;  ///< ‖f(t, position, 0)‖∞ [N], computed anew
  Status status;          ///< with KINSOL's own reason
  Work work;
};

/// Solves f(t, x, 0) = 0 for the positions by KINSOL: Newton's iteration with line search on ½‖f‖², KLU on
/// the tangent stiffness matrix, fresh in every iteration [Hindmarsh et al. 2005]. Fixed degrees of freedom
/// stay where they are (their rows of the matrix are those of the identity). It finds an equilibrium, not
/// necessarily a stable one.
/// Throws InputError where sizes or options are out of range; hands on what the system throws.
StaticEquilibrium find_static_equilibrium(const SecondOrderSystem& system, ConstVectorRef start,
                                          double time = 0.0, const EquilibriumOptions& options = {});

}  // namespace fw::oracles
