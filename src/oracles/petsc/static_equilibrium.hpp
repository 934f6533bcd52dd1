#pragma once

#include <string>

#include "core/status.hpp"
#include "core/work.hpp"
#include "ode/second_order_system.hpp"

namespace fw::oracles::snes {

/// How SNES globalises Newton's iteration.
enum class NewtonKind {
  line_search,   ///< newtonls: backtracking on ‖f‖₂
  trust_region,  ///< newtontr
};

struct EquilibriumOptions {
  NewtonKind kind = NewtonKind::line_search;
  /// The largest residual force, as a fraction of the largest force at the start (but at least of the largest
  /// weight or spring force that rounding lets one see, 1e-14 of it).
  double residual_tolerance = 1e-12;
  int maximum_iterations = 500;
  /// K of Newton's matrix. `exact` converges quadratically; the others keep −K semi-definite where springs
  /// are compressed.
  TangentModel tangent = TangentModel::exact;
  /// Newton's matrix is −K + μ I with μ = regularisation · ‖f‖∞/ℓ, ℓ the extent of the start: regular where K
  /// is not, and vanishing with the residual. 0: Newton's own method.
  double regularisation = 1.0;
  std::string petsc{};  ///< further options in PETSc's notation; they override everything else
};

/// Where all forces vanish, or what came of looking for it.
struct StaticEquilibrium {
  Vector position;        ///< n entries; the last iterate where the search has failed
  double residual = 0.0;  ///< ‖f(t, position, 0)‖∞ [N], computed anew
  Status status;          ///< with SNES's own reason
  Work work;
};

/// Solves f(t, x, 0) = 0 for the positions by PETSc's SNES, with KLU on the tangent stiffness matrix, fresh
/// in every iteration [Balay et al. 2022]. Fixed degrees of freedom stay where they are. It finds an
/// equilibrium, not necessarily a stable one. Throws InputError where sizes or options are out of range;
/// hands on what the system throws.
StaticEquilibrium find_static_equilibrium(const SecondOrderSystem& system, ConstVectorRef start,
                                          double time = 0.0, const EquilibriumOptions& options = {});

}  // namespace fw::oracles::snes
