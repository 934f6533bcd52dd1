#pragma once

#include <memory>

#include "ode/integrator.hpp"

namespace fw::oracles {

/// CVODE's variable-order, variable-step BDF (orders 1–5) with Newton's iteration on our analytic Jacobian
/// and KLU [Hindmarsh et al. 2005]. Adaptive; dense output by CVodeGetDky. CVODE's own message becomes the
/// Status.
std::unique_ptr<Integrator> make_cvode_bdf();

}  // namespace fw::oracles
