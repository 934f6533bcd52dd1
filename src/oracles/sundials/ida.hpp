#pragma once

#include <memory>

#include "ode/integrator.hpp"

namespace fw::oracles {

struct IdaOptions {
  /// The tolerances of a run as IDA gets them, as a fraction of those given: IDA bounds the error of a step,
  /// what it leaves in the solution is larger (decision 0017).
  double tolerance_factor = 1e-3;
};

/// IDA's variable-order, variable-step BDF (orders 1–5) on the residual F(t, y, ẏ) = 0, which is q̇ − v = 0,
/// M v̇ − f(t, q, v) = 0 for systems of second order and ẏ − f(t, y) = 0 otherwise [Hindmarsh et al. 2005].
/// Newton's iteration with our sparse Jacobian cj ∂F/∂ẏ + ∂F/∂y and KLU. Adaptive; dense output by IDAGetDky.
std::unique_ptr<Integrator> make_ida(const IdaOptions& options = {});

}  // namespace fw::oracles
