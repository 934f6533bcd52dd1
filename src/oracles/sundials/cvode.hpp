#pragma once

#include <memory>

#include "ode/integrator.hpp"

namespace fw::oracles {

struct CvodeOptions {
  /// CVODE controls the error of each step; what it leaves in the solution is larger, by two to four digits
  /// on undamped springs. The tolerances of a run are multiplied by this factor before CVODE gets them
  /// (relative ones not below 1e-13), so that they mean the accuracy of the solution, as an oracle's should.
  /// 1 gives them CVODE's own meaning.
  double tolerance_factor = 1e-3;
};

/// CVODE's variable-order, variable-step BDF (orders 1–5) with Newton's iteration on our analytic Jacobian
/// and KLU [Hindmarsh et al. 2005]. Adaptive; dense output by CVodeGetDky. CVODE's own message becomes the
/// Status.
std::unique_ptr<Integrator> make_cvode_bdf(const CvodeOptions& options = {});

}  // namespace fw::oracles
