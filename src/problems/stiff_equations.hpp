#pragma once

#include "problems/problem_entry.hpp"

namespace fw::problems {

/// Van der Pol's equation in the stiff scaling, ε ÿ = (1 − y²) ẏ − y; parameter `epsilon` > 0.
Problem van_der_pol(const ProblemParameters& given = {});
ProblemEntry van_der_pol_entry();

/// Robertson's chemical kinetics.
Problem robertson(const ProblemParameters& given = {});
ProblemEntry robertson_entry();

}  // namespace fw::problems
