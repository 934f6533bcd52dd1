#pragma once

#include <memory>

#include "analysis/reference_solution.hpp"
#include "ode/ivp.hpp"

namespace fw::analysis {

/// The problems on which schemes are verified. All are smooth, nonlinear, with masses other than 1 and several degrees
/// of freedom, on intervals whose ends are no special points.

/// M q̈ = f(t, q), 3 degrees of freedom, driven and anharmonic, on [0.3, 2.1].
const Ivp& driven_oscillators();
/// The same with nonlinear damping and a velocity coupling: M q̈ = f(t, q, q̇).
const Ivp& damped_oscillators();
/// ẏ = f(t, y), 3 unknowns, not of second order, on [0.2, 1.7].
const Ivp& first_order_flow();
/// M q̈ = −∇V(q): the Hamiltonian part of `driven_oscillators` on [0, 1.6]; its energy below.
const Ivp& conservative_oscillators();
double conservative_energy(ConstVectorRef y);
/// A spring network of 6 particles with masses other than 1, gravity, undamped, pinned at one corner.
const Ivp& spring_network();
/// The same with dampers and drag.
const Ivp& damped_spring_network();
/// Free of gravity, drag and fixed particles: momentum is conserved.
const Ivp& free_spring_network();

/// The certified end state of one of these, computed once per process.
const ReferenceState& certified_end(const Ivp& (*problem)());

}  // namespace fw::analysis
