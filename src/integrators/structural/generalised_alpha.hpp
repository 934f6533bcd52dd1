#pragma once

#include <memory>

#include "integrators/structural/alpha_family.hpp"

namespace fw::integrators {

struct GeneralisedAlphaOptions {
  double rho_infinity = 0.8;  ///< spectral radius at infinite frequency, 0 (annihilated) to 1 (kept)
};

/// α_m = (2ρ − 1)/(ρ + 1), α_f = ρ/(ρ + 1), γ = ½ − α_m + α_f, β = ¼ (1 − α_m + α_f)²; throws InputError
/// unless 0 ≤ ρ ≤ 1.
AlphaParameters alpha_parameters(const GeneralisedAlphaOptions& options);

/// The generalised-α scheme [Chung, Hulbert 1993]: of all schemes of `AlphaParameters` with the given damping
/// at infinite frequency the one with the least damping of low frequencies; order 2.
std::unique_ptr<Integrator> make_generalised_alpha(const GeneralisedAlphaOptions& options = {});

}  // namespace fw::integrators
