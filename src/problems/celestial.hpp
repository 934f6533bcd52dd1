#pragma once

#include "problems/problem_entry.hpp"

namespace fw::problems {

/// Kepler's problem q̈ = −q/‖q‖³ in the plane from the perihelion; parameter `eccentricity` in [0, 1).
/// Exact by Kepler's equation.
Problem kepler(const ProblemParameters& given = {});
ProblemEntry kepler_entry();

/// Hénon and Heiles' motion of a star in a galaxy.
Problem henon_heiles(const ProblemParameters& given = {});
ProblemEntry henon_heiles_entry();

/// The Pleiades: seven bodies in the plane with masses 1, …, 7.
Problem pleiades(const ProblemParameters& given = {});
ProblemEntry pleiades_entry();

}  // namespace fw::problems
