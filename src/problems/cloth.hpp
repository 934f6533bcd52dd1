#pragma once

#include "problems/problem_entry.hpp"

namespace fw::problems {

/// A small hanging cloth of count × count points with structural, shear and bend springs, held at two
/// corners: the mass-spring system of the lecture as a test problem [Zachmann 2011, S5-S7, S37]. Parameters
/// `count`, `mass` (of every point), `stiffness`, `damping`, `gravity`.
Problem cloth(const ProblemParameters& given = {});
ProblemEntry cloth_entry();

}  // namespace fw::problems
