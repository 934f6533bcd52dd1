#pragma once

#include <memory>
#include <vector>

#include "core/types.hpp"
#include "ode/integrator.hpp"

namespace fw::analysis {

/// Linear systems with one eigenvalue or one vibration, on which steps of the running code are made.
/// ẏ = λ y as a real system with two unknowns.
std::shared_ptr<const OdeSystem> planar_flow(Complex lambda);
/// ẏ = λ y with a real λ.
std::shared_ptr<const OdeSystem> decay(double lambda);
/// q̈ = −a q − b q̇ with unit mass; its forces are f(t, q) where b = 0.
std::shared_ptr<const OdeSystem> vibration(double a, double b);

/// The states after 0, 1, … `steps` steps of length h from `start`; empty if a step fails.
std::vector<Vector> states_after(const Integrator& integrator, const std::shared_ptr<const OdeSystem>& system,
                                 double h, int steps, const Vector& start);

/// Whether a scheme keeps more than the state: single steps from a state do not tell all of it.
bool carries_more(const MethodInfo& info);

/// The spectral radius of a step h of the running code on the moving part of a linear system. A scheme that
/// keeps more than the state is known by its positions: x_{n+1} = P x_n + Q x_{n−1} is fitted to three steps
/// from every unit state, and a fourth step tells whether there is such a recurrence. Infinite where a step
/// fails, NaN where there is no such recurrence.
double growth_of_steps(const Integrator& integrator, const std::shared_ptr<const OdeSystem>& system,
                       double h);

}  // namespace fw::analysis
