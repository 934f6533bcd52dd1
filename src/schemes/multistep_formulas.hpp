#pragma once

#include <vector>

#include "schemes/multistep_formula.hpp"

namespace fw::schemes {

/// The linear multistep methods: Adams–Bashforth 2–5, Adams–Moulton 2–5 and the backward differentiation
/// formulas 2–6. The number in a name is the order of accuracy, so that adams_moulton3 is the Adams–Moulton
/// method of two steps. The method of one step among them, adams_moulton2, is the trapezoidal rule.
const std::vector<MultistepFormula>& multistep_formulas();

}  // namespace fw::schemes
