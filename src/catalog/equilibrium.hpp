#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/status.hpp"
#include "ode/second_order_system.hpp"

namespace fw::catalog {

/// A solver of f(t, x, 0) = 0 by name.
struct EquilibriumSolver {
  std::string_view name, description;
};

/// "kinsol" (SUNDIALS) and "snes" (PETSc).
const std::vector<EquilibriumSolver>& equilibrium_solvers();

/// Where all forces vanish, or what came of looking for it.
struct Equilibrium {
  Vector position;           ///< n entries; the last iterate where the search has failed
  double residual = 0.0;     ///< ‖f(t, position, 0)‖∞ [N]
  double first_force = 0.0;  ///< ‖f(t, start, 0)‖∞ [N]
  std::string tangent;       ///< the tangent stiffness of Newton's matrix: "exact" or "psd_projection"
  Status status;             ///< of every attempt where all have failed
  std::uint64_t iterations = 0, force_evaluations = 0;  ///< of all attempts
};

/// Looks for a static equilibrium from `start` by Newton's iteration, first with the exact tangent stiffness;
/// where that ends without one, once more with the projected tangent, which follows falling energy where
/// springs are compressed. `solver` is a name of the list. Throws InputError for an unknown solver and where
/// no particle can move.
Equilibrium find_equilibrium(const SecondOrderSystem& system, ConstVectorRef start, double time = 0.0,
                             std::string_view solver = "kinsol");

/// The positions of an equilibrium. Throws InputError with the reason where none is found.
Vector require_equilibrium(const SecondOrderSystem& system, ConstVectorRef start);

/// The lowest vibration about a state at rest, λ of −K x = λ M x over what can move [1/s²]: positive where
/// the equilibrium is stable (√λ is its angular frequency), zero where something moves without force.
struct LowestMode {
  double lambda = 0.0;   ///< [1/s²]
  double largest = 0.0;  ///< the largest λ [1/s²]; below 1e-9 of it λ counts as zero
  Status status{};       ///< of the eigenvalue solver

  bool is_stable() const { return lambda > 1e-9 * largest; }
  bool is_unstable() const { return lambda < -1e-9 * largest; }
};

/// By dense methods up to 600 degrees of freedom that move, by SLEPc above.
LowestMode lowest_mode(const SecondOrderSystem& system, ConstVectorRef position, double time = 0.0);

}  // namespace fw::catalog
