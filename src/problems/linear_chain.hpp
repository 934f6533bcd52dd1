#pragma once

#include "problems/problem_entry.hpp"

namespace fw::problems {

/// N equal masses in a row between two fixed ends, joined by N + 1 equal linear springs, longitudinal
/// displacements: m ü_i = k (u_{i−1} − 2u_i + u_{i+1}), u_0 = u_{N+1} = 0. Parameters `count` (N), `mass`,
/// `stiffness`. Exact by its normal modes, ω_j = 2 √(k/m) sin(jπ/(2(N+1))).
Problem linear_chain(const ProblemParameters& given = {});
ProblemEntry linear_chain_entry();

}  // namespace fw::problems
