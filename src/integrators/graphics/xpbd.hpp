#pragma once

#include <memory>

#include "ode/integrator.hpp"

namespace fw::integrators {

struct XpbdOptions {
  int substeps = 10;   ///< of a step, each of length h/substeps [Macklin et al. 2019]
  int iterations = 1;  ///< Gauss–Seidel sweeps over the springs per substep
};

/// Extended position-based dynamics, XPBD, with substeps [Macklin, Müller, Chentanez 2016; Macklin et al.
/// 2019]. In each substep of length τ: v̂ = v + τ M⁻¹ f_ext(q, v), q' = q + τ v̂, then sweeps over springs and
/// anchors, each corrected along its gradient by the multiplier of the compliant, damped constraint C = L −
/// l₀,
///   Δλ = −(C + α̃ λ + γ ∇C·(q' − q)) / ((1 + γ) ∇C M⁻¹ ∇Cᵀ + α̃),   α̃ = 1/(k τ²),   γ = k_d/(k τ),
/// and v' = (q' − q)/τ. The dampers of springs and anchors are in γ; gravity, drag and obstacles in f_ext.
///
/// Order 1 in h (and in h/substeps). Stable at any stiffness, but with few sweeps stiff networks look softer
/// than they are.
std::unique_ptr<Integrator> make_xpbd(const XpbdOptions& options = {});

}  // namespace fw::integrators
