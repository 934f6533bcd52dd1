#pragma once

#include <vector>

#include "schemes/rosenbrock_tableau.hpp"

namespace fw::schemes {

/// Rosenbrock methods in the form of `RosenbrockTableau`; sources that print transformed coefficients
/// (a = αΓ⁻¹, C = diag(1/γ) − Γ⁻¹, m = bΓ⁻¹) are converted.
const std::vector<RosenbrockTableau>& rosenbrock_tableaus();

}  // namespace fw::schemes
