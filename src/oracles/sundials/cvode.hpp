#pragma once

#include <memory>
#include <optional>

#include "ode/integrator.hpp"
#include "oracles/sundials/vector_operations.hpp"

namespace fw::oracles {

/// CVODE's families of variable-order, variable-step linear multistep formulas.
enum class CvodeFormula {
  bdf,    ///< backward differentiation formulas, orders 1–5, for stiff systems
  adams,  ///< Adams–Moulton formulas, orders 1–12
};

/// How the implicit equation of a step is solved.
enum class CvodeIteration {
  newton,       ///< modified Newton
  fixed_point,  ///< functional iteration: no matrix, converges where h‖J‖ is small
};

/// How Newton's linear equations (I − γJ) x = b are solved.
enum class CvodeLinearSolver {
  klu,    ///< sparse LU of our analytic Jacobian
  spgmr,  ///< GMRES on products J·w without assembly, preconditioned by `BlockPreconditioner`
};

struct CvodeOptions {
  /// CVODE controls the error of each step; what it leaves in the solution is larger, by two to four digits
  /// on undamped springs. The tolerances of a run are multiplied by this factor before CVODE gets them
  /// (relative ones not below 1e-13), so that they mean the accuracy of the solution, as an oracle's should.
  /// 1 gives them CVODE's own meaning.
  double tolerance_factor = 1e-3;
  std::optional<CvodeIteration> iteration{};  ///< default: newton for bdf, fixed_point for adams
  CvodeLinearSolver linear_solver = CvodeLinearSolver::klu;
  int krylov_dimension = 20;  ///< of GMRES, without restart, >= 1
  /// BDF only: lowers the order where the formulas of orders 3–5 meet their limit of stability near the
  /// imaginary axis (Hindmarsh's STALD).
  bool stability_limit_detection = false;
  int maximum_order = 0;  ///< 1–5 or 1–12; 0: the formula's own
  VectorOperations vector = VectorOperations::eigen;
};

/// CVODE's variable-order, variable-step BDF, orders 1–5 [Hindmarsh et al. 2005]. Adaptive; dense output by
/// CVodeGetDky. CVODE's own message becomes the Status; an exception of the right-hand side goes through to
/// the caller. Throws InputError where an option is out of range.
std::unique_ptr<Integrator> make_cvode_bdf(const CvodeOptions& options = {});

/// The same with CVODE's Adams–Moulton formulas, orders 1–12.
std::unique_ptr<Integrator> make_cvode_adams(const CvodeOptions& options = {});

}  // namespace fw::oracles
