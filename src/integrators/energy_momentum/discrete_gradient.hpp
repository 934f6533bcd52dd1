#pragma once

#include <memory>

#include "ode/integrator.hpp"

namespace fw::integrators {

/// The energy–momentum scheme for mass-spring systems with the exact discrete gradient of every spring
/// [LaBudde, Greenspan 1976; Gonzalez 1996; Simo, Tarnow, Wong 1992]:
///   q' = q + ½h (v + v'),   M (v' − v) = h f̄(q, q', ½(v + v')),
/// see `discrete_spring_force`. Gravity and anchors are linear or quadratic and exact by the midpoint; drag
/// and dampers take the mean velocity. Without damping the energy, and without external forces linear and
/// angular momentum are conserved to Newton's tolerance at any step. Obstacles act by their force at the
/// midpoint, which conserves energy to O(h²) of a contact only. Order 2.
std::unique_ptr<Integrator> make_discrete_gradient();

}  // namespace fw::integrators
