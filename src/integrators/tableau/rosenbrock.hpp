#pragma once

#include <memory>

#include "integrators/loop/step_size_controller.hpp"
#include "ode/integrator.hpp"
#include "schemes/rosenbrock_tableau.hpp"

namespace fw::integrators {

/// A Rosenbrock method with the exact Jacobian (with a damper's position derivative): one factorisation of I
/// − hγJ and s solves per step, no iteration [Hairer, Wanner 1996, IV.7]. A second-order system is reduced to
/// half its size, see `ShiftedJacobian`. Runs in the transformed variables u = Γk, which need no product with
/// J:
///   (I − hγJ) u_i = hγ [f(t + α_i h, y + Σ a_ij u_j) + γ_i h ∂f/∂t] + γ Σ c_ij u_j,   y' = y + Σ m_i u_i,
///   a = αΓ⁻¹,  C = diag(1/γ) − Γ⁻¹,  m = bΓ⁻¹.
///
/// ∂f/∂t is the five-point central difference with the increment h/256: its error O(h⁴/10¹⁰) does not lower
/// any order, and it is exactly zero, after two evaluations, where f does not depend on time. All are
/// counted.
///
/// Where the tableau has an embedded solution, steps can be chosen by h Σ (b_i − b̂_i) k_i. Throws
/// std::logic_error where the diagonal of Γ is not constant or zero.
std::unique_ptr<Integrator> make_rosenbrock(const schemes::RosenbrockTableau& tableau,
                                            const ControllerOptions& controller = {});

}  // namespace fw::integrators
