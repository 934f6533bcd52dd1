#pragma once

#include <memory>
#include <string>

#include "ode/integrator.hpp"
#include "oracles/sundials/arkode_table_names.hpp"
#include "schemes/additive_tableau.hpp"
#include "schemes/butcher_tableau.hpp"

namespace fw::oracles {

/// How ARKODE's one-step methods are run [Reynolds et al. 2023].
struct ArkodeOptions {
  /// The tolerances of a run as ARKODE gets them, as a fraction of those given (decision 0017).
  double tolerance_factor = 1.0;
  /// With chosen steps: what Newton's iteration may leave, as a fraction of the tolerances.
  double newton_coefficient = 0.01;
  /// With constant steps: what it may leave relative to the state; by default the level of rounding, so that
  /// a step is that of the tableau and nothing else.
  double newton_tolerance = 1e-14;
};

/// Of the implicit methods: their estimate of the error of a step understates that of the solution by two
/// digits more than the explicit ones' (decision 0023).
inline constexpr ArkodeOptions implicit_arkode_options{.tolerance_factor = 1e-2};

/// ARKODE's engine for explicit Runge–Kutta methods with one of its own tables (`arkode_explicit_tables`) or
/// one of our tableaus. Adaptive where there is an error estimate, and constant steps; dense output by
/// ARKStepGetDky. `Work::rhs_evaluations` counts each call of a part of the right-hand side.
/// InputError for an unknown table, std::logic_error for a tableau of another shape.
std::unique_ptr<Integrator> make_arkode_erk(const std::string& table = "dormand_prince_7_4_5",
                                            const ArkodeOptions& options = {});
std::unique_ptr<Integrator> make_arkode_erk(const schemes::ButcherTableau& tableau,
                                            const ArkodeOptions& options = {});

/// The same for diagonally implicit methods (`arkode_diagonally_implicit_tables`): Newton's iteration with
/// our sparse Jacobian and KLU.
std::unique_ptr<Integrator> make_arkode_dirk(const std::string& table = "ark548l2sa_dirk_8_4_5",
                                             const ArkodeOptions& options = implicit_arkode_options);
std::unique_ptr<Integrator> make_arkode_dirk(const schemes::ButcherTableau& tableau,
                                             const ArkodeOptions& options = implicit_arkode_options);

/// The same for additive methods (`arkode_additive_tables`): (v, M⁻¹f_stiff) is implicit, (0, M⁻¹f_soft)
/// explicit, as the system splits its forces.
std::unique_ptr<Integrator> make_arkode_imex(const std::string& table = "ark548l2sa_8_4_5",
                                             const ArkodeOptions& options = implicit_arkode_options);
std::unique_ptr<Integrator> make_arkode_imex(const schemes::AdditiveTableau& tableau,
                                             const ArkodeOptions& options = implicit_arkode_options);

}  // namespace fw::oracles
