#pragma once

#include "ode/ode_system.hpp"

namespace fw::analysis {

/// J = ∂f/∂y (N×N) of `system.rhs` at (t, y) by complex steps, J e_j = Im f(t, y + iε e_j)/ε with ε = 1e-200:
/// no subtraction, hence exact to rounding where f is analytic [Squire, Trapp 1998]. Costs N right-hand
/// sides.
Matrix complex_step_jacobian(const OdeSystem& system, double t, ConstVectorRef y);

enum class Difference {
  forward,  ///< (f(y + h e_j) − f(y))/h: error ½h|f''| + 2ε|f|/h, least near h = √ε
  central,  ///< (f(y + h e_j) − f(y − h e_j))/(2h): error h²|f'''|/6 + ε|f|/h, least near h = ∛ε
};

/// J by differences with the same increment h in every component [Nocedal, Wright 2006, 8.1].
Matrix difference_jacobian(const OdeSystem& system, double t, ConstVectorRef y, double increment,
                           Difference difference);

/// `system.jacobian` as a dense matrix.
Matrix analytic_jacobian(const OdeSystem& system, double t, ConstVectorRef y);

}  // namespace fw::analysis
