#pragma once

#include "ode/integrator.hpp"
#include "schemes/butcher_tableau.hpp"

namespace fw::integrators {

/// An implicit Runge–Kutta method in binary128 with constant steps: the coupled stages of the first-order
/// system by simplified Newton iterations, residuals in binary128 and matrices in double. Each iteration
/// gains the digits that a frozen Jacobian gains, so that it ends at the rounding of binary128. Values that
/// are not finite where it does not.
ExtendedSolver make_extended_runge_kutta(const schemes::ButcherTableau& tableau);

}  // namespace fw::integrators
