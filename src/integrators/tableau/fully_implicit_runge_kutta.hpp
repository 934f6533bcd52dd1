#pragma once

#include <memory>

#include "integrators/implicit/stage_solver.hpp"
#include "ode/integrator.hpp"
#include "schemes/butcher_tableau.hpp"
#include "schemes/nystrom_tableau.hpp"

namespace fw::integrators {

/// Fully implicit Runge–Kutta, given by its tableau, for example of Gauss, Radau or Lobatto type. The coupled
/// stages are solved by simplified Newton iterations with J from the start of a step and one sparse LU
/// factorisation (KLU), which is kept while it converges well [Hairer, Wanner 1996, IV.8].
///
/// First-order systems: k_i = f(t + c_i h, y + h Σ_j a_ij k_j) with the sN × sN matrix I − hA⊗J.
/// Second-order systems are reduced to the accelerations k_i of the stages,
///   M k_i = f(t + c_i h, q + c_i h v + h² Σ_j (A²)_ij k_j, v + h Σ_j a_ij k_j),   M − hA⊗D − h²A²⊗K,
/// and the step is made with k_i = M⁻¹f of the last forces, so that momentum changes by forces only.
/// The iteration starts from the interpolation polynomial of the last step's slopes.
///
/// Constant steps. Has a binary128 version, which uses the same iteration with residuals in binary128.
std::unique_ptr<Integrator> make_fully_implicit_runge_kutta(const schemes::ButcherTableau& tableau,
                                                            const ImplicitOptions& options = {});

/// A Nyström method with coupled stages, for example a partitioned Lobatto pair, in the same way: the
/// accelerations of the stages with ā in place of A² and a in place of A. Constant steps, with a binary128
/// version (fixed-point iteration).
std::unique_ptr<Integrator> make_implicit_nystrom(const schemes::NystromTableau& tableau,
                                                  const ImplicitOptions& options = {});

}  // namespace fw::integrators
