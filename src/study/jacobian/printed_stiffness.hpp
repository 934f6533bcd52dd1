#pragma once

#include "mechanics/mass_spring_model.hpp"

namespace fw::study {

/// The mistakes of the lecture's derivative of the spring force.
enum class Erratum {
  e1,  ///< [Zachmann 2011, S28, S30]: K_ii = k_s(−I + l₀/L I + 2 l₀/L³ d dᵀ), where −l₀/L³ d dᵀ is right
  e2,  ///< [Zachmann 2011, S29]: K_ij = −K_ji, where K_ij = K_ji is right
};

/// K = ∂f/∂q (3n×3n) [N/m] of undamped Hooke springs, with the one mistake in it and all else correct. For
/// comparison only: nothing computes with it.
Matrix printed_stiffness(const mechanics::MassSpringModel& model, ConstVectorRef q, Erratum erratum);

/// By how much the mistake makes a 3×3 block of one spring wrong, in the spectral norm [N/m]:
/// ‖3 k_s l₀/L³ d dᵀ‖ = 3 k_s l₀/L in K_ii (E1); ‖2 K_ji‖ = 2 k_s max(1, |1 − l₀/L|) in K_ji (E2).
double printed_error(double stiffness, double rest_length, double length, Erratum erratum);

}  // namespace fw::study
