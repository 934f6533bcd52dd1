#pragma once

#include <memory>

#include "ode/integrator.hpp"

namespace fw::integrators {

struct AverageVectorFieldOptions {
  int quadrature_points = 4;  ///< of Gauss–Legendre, 1 to 8; with one point it is the implicit midpoint rule
};

/// The average vector field scheme on M q̈ = f(t, q, v), y' = y + h ∫₀¹ F(t + ξh, y + ξ(y' − y)) dξ
/// [Quispel, McLaren 2008]:
///   q' = q + ½h (v + v'),   M (v' − v) = h Σ_i w_i f(t + c_i h, q + c_i (q' − q), v + c_i (v' − v)).
/// It conserves the energy of conservative forces as far as Gauss's quadrature with m points is exact:
/// polynomial potentials of degree ≤ 2m to rounding, others to a remainder that is exponentially small in m.
/// Order 2; linear momentum is conserved, angular momentum is not.
///
/// Newton's iteration to convergence with the exact matrix M − h Σ w_i c_i (D_i + ½h K_i).
std::unique_ptr<Integrator> make_average_vector_field(const AverageVectorFieldOptions& options = {});

}  // namespace fw::integrators
