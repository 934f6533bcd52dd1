#pragma once

#include <memory>

#include "ode/integrator.hpp"

namespace fw::integrators {

/// How the two-step Verlet scheme finds the velocity that a velocity-dependent force needs (erratum E6).
enum class VerletVelocity {
  central,   ///< v_n = (x_{n+1} − x_{n−1})/(2h), implicit in x_{n+1} and solved: order 2
  backward,  ///< v_n ≈ (x_n − x_{n−1})/h, the obvious estimate: order 1
};

/// The lecture's two-step Verlet (Störmer) scheme, x_{n+1} = 2x_n − x_{n−1} + h² M⁻¹ f_n with
/// x₁ = x₀ + h v₀ + ½h² M⁻¹ f₀ [Zachmann 2011, S17-S18].
///
/// Computed in the algebraically identical summed form d_{n+1} = d_n + h² M⁻¹ f_n, x_{n+1} = x_n + d_{n+1},
/// whose rounding error does not grow like 1/h² [Hairer, Lubich, Wanner 2006, VIII.5]. Reported velocities
/// are the central differences v_n = (x_{n+1} − x_{n−1})/(2h) = d_n/h + ½h M⁻¹ f_n; they need no future
/// state.
std::unique_ptr<Integrator> make_verlet(VerletVelocity velocity);

}  // namespace fw::integrators
