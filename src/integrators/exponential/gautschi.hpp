#pragma once

#include <memory>

#include "ode/integrator.hpp"

namespace fw::integrators {

/// The filters ψ, ψ₀, ψ₁ of the nonlinear force and φ of its argument, as functions of ξ = hω.
enum class TrigonometricFilter {
  gautschi,   ///< ψ = sinc²(ξ/2), ψ₀ = ψ₁ = sinc ξ, φ = 1 [Gautschi 1961]
  deuflhard,  ///< ψ = sinc ξ, ψ₀ = cos ξ, ψ₁ = 1, φ = 1 [Deuflhard 1979]; symplectic
  mollified_impulse,  ///< ψ = sinc² ξ, ψ₀ = cos ξ sinc ξ, ψ₁ = sinc ξ, φ = sinc ξ [García-Archilla et al.
                      ///< 1999]; symplectic
};

struct GautschiOptions {
  TrigonometricFilter filter = TrigonometricFilter::gautschi;
};

/// Largest number of moving degrees of freedom, since the matrix functions are dense.
inline constexpr int largest_gautschi_size = 600;

/// A trigonometric scheme for M q̈ = f(t, q) with stiff, nearly linear oscillations [Hairer, Lubich, Wanner
/// 2006, XIII.2; Hochbruck, Lubich 1999]. With x = M^{1/2}(q − q₀), Ω² the positive part of −M^{-1/2} K
/// M^{-1/2}, K = ∂f/∂q at the start state, and the rest of the force g(t, x) = M^{-1/2} f + Ω² x:
///   x' = cos(hΩ) x + Ω⁻¹ sin(hΩ) ẋ + ½h² Ψ g(t, Φx),
///   ẋ' = −Ω sin(hΩ) x + cos(hΩ) ẋ + ½h (Ψ₀ g(t, Φx) + Ψ₁ g(t + h, Φx')).
/// Exact where f is linear in q, whatever h. Order 2. One force per step.
///
/// Ω comes from a dense symmetric eigendecomposition at the start of the run: throws InputError where more
/// than `largest_gautschi_size` degrees of freedom move.
std::unique_ptr<Integrator> make_gautschi(const GautschiOptions& options = {});

}  // namespace fw::integrators
