#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "ode/ivp.hpp"

namespace fw::integrators {

/// One step in binary128: y at t becomes y at t + h.
using ExtendedStep = std::function<void(const Float128& t, const Float128& h, std::vector<Float128>& y)>;

/// The end state of `ivp` after `steps` equal steps.
std::vector<Float128> run_extended_steps(const Ivp& ivp, std::uint64_t steps, const ExtendedStep& step);

/// ∂f/∂y at (t, y), row by row, by central differences in binary128 (error about 1e-22 relative).
std::vector<Float128> extended_jacobian(const OdeSystem& system, const Float128& t,
                                        const std::vector<Float128>& y);

/// Solves A x = b in place (A row by row, overwritten; b becomes x) by elimination with partial pivoting. For
/// the small systems on which orders are measured.
void solve_extended_system(std::vector<Float128>& A, std::vector<Float128>& b);

}  // namespace fw::integrators
