#pragma once

#include <memory>

#include "integrators/structural/alpha_family.hpp"

namespace fw::integrators {

struct NewmarkOptions {
  double beta = 0.25;  ///< ¼: average acceleration; 1/6: linear acceleration; 0: central differences
  double gamma = 0.5;  ///< ½: order 2; above: numerical damping and order 1
};

/// α_m = α_f = 0; throws InputError unless 0 ≤ β ≤ ½ and ½ ≤ γ ≤ 1.
AlphaParameters alpha_parameters(const NewmarkOptions& options);

/// Newmark's scheme on M q̈ = f(t, q, v) [Newmark 1959]: see `AlphaParameters`. With β = 0, γ = ½ it is
/// velocity Verlet.
std::unique_ptr<Integrator> make_newmark(const NewmarkOptions& options = {});

}  // namespace fw::integrators
