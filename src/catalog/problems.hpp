#pragma once

#include <vector>

#include "problems/problem_entry.hpp"

namespace fw::catalog {

/// Every problem. The only place where one is registered.
const std::vector<ProblemEntry>& problems();

/// Throws InputError with the nearest name.
const ProblemEntry& find_problem(const std::string& name);

}  // namespace fw::catalog
