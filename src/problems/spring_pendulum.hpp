#pragma once

#include "problems/problem_entry.hpp"

namespace fw::problems {

/// A mass that hangs on a (stiff) spring and swings in space: m q̈ = −k (‖q‖ − l₀) q/‖q‖ + m g. Parameters
/// `mass`, `stiffness`, `rest_length`, `gravity`. Large stiffness makes it a stiff nonlinear oscillator.
Problem spring_pendulum(const ProblemParameters& given = {});
ProblemEntry spring_pendulum_entry();

}  // namespace fw::problems
