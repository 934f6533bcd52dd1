#pragma once

#include <string>
#include <vector>

#include "ode/integrator.hpp"
#include "study/jacobian/jacobian_states.hpp"
#include "study/plan.hpp"
#include "study/problem_spec.hpp"

namespace fw::study {

/// The keys of [runs].
struct CompressedRunSettings {
  std::vector<double> steps;         ///< h [s]
  std::vector<double> compressions;  ///< factors of all distances
  Compression start;                 ///< `compression` is one of the list
};

/// One method from the compressed state of a mass-spring problem over the step: whether it reaches the end, and
/// the largest energy on the way. The lecture claims "unconditionally stable" of implicit Euler [Zachmann
/// 2011, S22, S32; erratum E5], for which the exact motion is the measure: its energy never rises. There is
/// no theory that predicts a number, so that there is no verdict.
CaseResult run_compressed(const StudyProblem& problem, const std::string& call, const Integrator& integrator,
                          double compression, const CompressedRunSettings& settings,
                          const RunContext& context);

}  // namespace fw::study
