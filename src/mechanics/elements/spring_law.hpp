#pragma once

namespace fw::mechanics {

/// The law of a spring between points i and j with d = x_j − x_i, L = ‖d‖, r = d/L and rest length l₀.
/// Force on i (−force on j); the damper adds k_d ((v_j − v_i)·r) r under every law.
enum class SpringLaw {
  hooke,         ///< k_s (L − l₀) r, k_s in N/m [Zachmann 2011, S6]
  strain,        ///< k_s (L − l₀)/l₀ r, k_s in N [Zachmann 2011, S7]
  tension_only,  ///< as hooke while L ≥ l₀, zero below (a rope); the damper stays
};

}  // namespace fw::mechanics
