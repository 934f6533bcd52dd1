#pragma once

#include "core/work.hpp"
#include "integrators/loop/step_size_controller.hpp"
#include "ode/ivp.hpp"

namespace fw::integrators {

/// A first step for a scheme of order p: h such that h^{p+1} max(‖f‖, ‖f'‖) is a hundredth of the tolerance,
/// from two right-hand sides [Hairer, Nørsett, Wanner 1993, II.4, "Starting Step Size"].
double initial_step(const Ivp& ivp, const AdaptiveStep& tolerances, ErrorNorm norm, int order, Work& work);

}  // namespace fw::integrators
