#pragma once

#include <functional>
#include <string>
#include <vector>

#include "study/jacobian/jacobian_states.hpp"
#include "study/plan.hpp"

namespace fw::study {

/// The keys of [derivatives].
struct DerivativeSettings {
  double tolerance = 1e-12;           ///< largest relative deviation of an analytic derivative that holds
  double slope_tolerance = 0.1;       ///< largest |observed − predicted slope| of a difference that holds
  double largest_increment = 0.1;     ///< h, in typical lengths
  double smallest_increment = 1e-14;  ///< likewise
  std::int64_t per_decade = 4;        ///< increments
};

/// A formula for the derivative: "analytic", "forward", "central", "printed_e1", "printed_e2".
const std::vector<std::string>& derivative_formulas();

/// Samples of one subject, drawn when its case runs.
struct DerivativeSubject {
  std::string label;
  std::function<std::vector<JacobianSample>()> draw;
};

/// One formula on all samples of a subject, against complex steps. Of M q̈ = f the matrices are K = ∂f/∂q and
/// D = ∂f/∂v, of other systems the Jacobian of the right-hand side. Verdicts:
///  - analytic: deviates by rounding only;
///  - printed_e1, printed_e2: wrong by what the mistake predicts, in every sample;
///  - forward, central: the error over the increment falls with slope 1 or 2, rises with slope −1, and is
///    least within a decade of √ε or ∛ε.
CaseResult run_derivative(const DerivativeSubject& subject, const std::string& formula,
                          const DerivativeSettings& settings, const RunContext& context);

/// The 3×3 (or 1×1) blocks of a system's tangent pattern at its initial state, against the blocks that
/// complex steps fill. Verdict: nothing is filled that the pattern has not.
CaseResult run_pattern(const DerivativeSubject& subject, const RunContext& context);

}  // namespace fw::study
