#pragma once

#include <cstdint>

namespace fw {

/// What a run has cost, counted where the work is done.
struct Work {
  std::uint64_t rhs_evaluations = 0;       ///< right-hand sides, or forces of a second-order system
  std::uint64_t jacobian_evaluations = 0;  ///< assembled Jacobians or tangent matrices
  std::uint64_t jacobian_products = 0;     ///< Jacobian–vector products without assembly
  std::uint64_t factorisations = 0;        ///< numerical factorisations
  std::uint64_t linear_solves = 0;         ///< solves with a right-hand side
  std::uint64_t linear_iterations = 0;     ///< iterations of Krylov solvers
  std::uint64_t newton_iterations = 0;     ///< Newton corrections
  std::uint64_t accepted_steps = 0;        ///< steps that advanced time
  std::uint64_t rejected_steps = 0;        ///< steps that were computed and thrown away
  double seconds = 0.0;                    ///< wall-clock time [s]
};

}  // namespace fw
