#pragma once

#include <memory>

#include "ode/integrator.hpp"

namespace fw::integrators {

struct ExponentialOptions {
  double krylov_tolerance =
      1e-12;  ///< of a φ-function's product, relative to the size of state and increment, in (0, 1]
  int krylov_dimension =
      200;  ///< largest dimension of the Krylov space; the run fails where it does not suffice
};

/// The exponential Rosenbrock–Euler scheme [Hochbruck, Ostermann 2010, 2.5; Pope 1963],
///   y' = y + h φ₁(hJ) f(t, y) + h² φ₂(hJ) ∂f/∂t,   J = ∂f/∂y at (t, y),
/// order 2, exact on ẏ = J y + b + c t. One evaluation of f and two for the difference that stands for ∂f/∂t.
///
/// Both φ-functions come out of one: with the system ỹ = (y, s), ṡ = 1, they are φ₁(hJ̃)(f, 1). Its product is
/// formed in a Krylov space (Arnoldi with products J·w, no matrix), whose dimension grows until Saad's
/// a-posteriori estimate is below the tolerance [Saad 1992; Niesen, Wright 2012].
std::unique_ptr<Integrator> make_exponential_rosenbrock_euler(const ExponentialOptions& options = {});

}  // namespace fw::integrators
