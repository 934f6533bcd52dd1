#pragma once

#include <memory>

#include "ode/integrator.hpp"

namespace fw::integrators {

struct RungeKuttaChebyshevOptions {
  int order = 2;   ///< 1 or 2
  int stages = 8;  ///< 0: from the step and an estimate of the spectral radius of J
};

/// The fewest and the most stages that a step may have.
inline constexpr int fewest_chebyshev_stages = 2;
inline constexpr int most_chebyshev_stages = 500;

/// The explicit stabilised method of `schemes::ChebyshevRecurrence`, for stiffness by strong dampers:
/// eigenvalues near the negative real axis. (Undamped oscillations lie outside its region of stability, as
/// with every long-real-axis method.)
///
/// With stages = 0 every step takes as many stages as h·ϱ(J) asks for. ϱ comes from a power iteration with
/// products J·w, begun anew every 25 steps from the last eigenvector, and 10 % are added; more than
/// `most_chebyshev_stages` end the run with the Status step_limit.
std::unique_ptr<Integrator> make_runge_kutta_chebyshev(const RungeKuttaChebyshevOptions& options = {});

}  // namespace fw::integrators
