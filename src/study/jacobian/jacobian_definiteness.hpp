#pragma once

#include <string>
#include <vector>

#include "ode/second_order_system.hpp"
#include "study/jacobian/jacobian_states.hpp"
#include "study/plan.hpp"
#include "study/problem_spec.hpp"

namespace fw::study {

/// The keys of [definiteness].
struct DefinitenessSettings {
  std::vector<double> compressions;  ///< factors of all distances
  std::vector<double> steps;         ///< h [s]
  Compression start;                 ///< `compression` is one of the list
};

/// "exact", "tensile_geometric_term", "psd_projection".
const std::vector<std::string>& tangent_model_names();
TangentModel tangent_model(const std::string& name);

/// K and the matrix A = M − h D − h² K of an implicit step, symmetrised and on the moving degrees of freedom,
/// with one tangent model, from the compressed state of a problem over compression and h: their smallest
/// eigenvalues, the step from which A is indefinite, and what Newton's iteration (one step of implicit Euler)
/// and conjugate gradients (the system of the linearised step) make of it. Verdict: A is definite up to the
/// step 1/μ that the spectrum predicts
/// (`analysis::fastest_growth_rate`), with psd_projection at every step, and conjugate gradients fail
/// nowhere where A is definite.
CaseResult run_definiteness(const StudyProblem& problem, const std::string& model,
                            const DefinitenessSettings& settings, const RunContext& context);

}  // namespace fw::study
