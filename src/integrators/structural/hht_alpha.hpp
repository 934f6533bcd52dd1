#pragma once

#include <memory>

#include "integrators/structural/alpha_family.hpp"

namespace fw::integrators {

struct HhtAlphaOptions {
  double alpha = -0.1;  ///< in [−1/3, 0] as in the original paper; 0: no numerical damping
};

/// α_f = −α, α_m = 0, γ = ½ − α, β = ¼ (1 − α)²; throws InputError unless −1/3 ≤ α ≤ 0.
AlphaParameters alpha_parameters(const HhtAlphaOptions& options);

/// The scheme of Hilber, Hughes and Taylor, M a' = (1 + α) f(t + h, q', v') − α f(t, q, v) with γ = ½ − α and
/// β = ¼ (1 − α)²: order 2 with damping of high frequencies [Hilber, Hughes, Taylor 1977]. See
/// `AlphaParameters`.
std::unique_ptr<Integrator> make_hht_alpha(const HhtAlphaOptions& options = {});

}  // namespace fw::integrators
