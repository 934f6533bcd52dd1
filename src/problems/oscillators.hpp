#pragma once

#include "problems/problem_entry.hpp"

namespace fw::problems {

/// m q̈ = −k q with m ≠ 1; parameters `mass`, `stiffness`.
Problem harmonic_oscillator(const ProblemParameters& given = {});
ProblemEntry harmonic_oscillator_entry();

/// m q̈ = −k q − c q̇ with m ≠ 1; parameters `mass`, `stiffness`, `damping` (under-, critically or overdamped).
Problem damped_oscillator(const ProblemParameters& given = {});
ProblemEntry damped_oscillator_entry();

/// The driven, damped Duffing oscillator m q̈ = −c q̇ − k q − β q³ + F cos ωt with m ≠ 1: small, nonlinear,
/// non-autonomous and velocity-dependent, hence a hard test of a scheme's order. Parameters `mass`,
/// `damping`, `stiffness`, `cubic_stiffness`, `force_amplitude`, `force_frequency`.
Problem driven_duffing(const ProblemParameters& given = {});
ProblemEntry driven_duffing_entry();

}  // namespace fw::problems
