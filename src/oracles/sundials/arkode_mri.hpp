#pragma once

#include <memory>
#include <string>

#include "ode/integrator.hpp"
#include "oracles/sundials/arkode_table_names.hpp"

namespace fw::oracles {

/// How the fast forces are integrated between the stages of the slow ones.
struct MriOptions {
  std::string coupling = "mri_gark_erk45a";  ///< of `arkode_couplings`
  bool inner_is_implicit = false;            ///< diagonally implicit table with Newton and KLU
  std::string inner_table{};                 ///< of ARKODE's; empty: of the coupling's order or more
  /// Constant inner steps per step, at least one between two stages; 0: chosen by inner_tolerance.
  int inner_steps = 20;
  double inner_tolerance = 1e-10;  ///< relative, and absolute as a fraction of the state's size
};

/// MRIStep, ARKODE's multirate infinitesimal methods [Sandu 2019; Reynolds et al. 2023]: constant steps with
/// an explicit method for (0, M⁻¹f_soft); between its stages ARKStep integrates (v, M⁻¹f_stiff) with the
/// slow part as a polynomial in time. The order is that of the coupling as long as the inner integration is
/// as accurate. InputError for unknown names or values out of range.
std::unique_ptr<Integrator> make_arkode_mri(const MriOptions& options = {});

}  // namespace fw::oracles
