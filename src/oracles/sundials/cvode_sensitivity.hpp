#pragma once

#include <vector>

#include "mechanics/spring_parameter_derivative.hpp"
#include "oracles/sundials/cvode.hpp"

namespace fw::oracles {

/// When CVODES solves for the sensitivities of a step [Serban, Hindmarsh 2005].
enum class SensitivityCorrector {
  simultaneous,  ///< together with the state
  staggered,     ///< after the state has passed its error test
};

struct SensitivityOptions {
  CvodeFormula formula = CvodeFormula::bdf;
  CvodeOptions cvode{};  ///< the iteration has to be Newton's
  SensitivityCorrector corrector = SensitivityCorrector::simultaneous;
  bool error_control = true;  ///< steps are chosen by the errors of the sensitivities too
};

/// The end of a run and its derivatives.
struct SolutionWithSensitivity {
  Solution solution;
  /// ∂y(t₁)/∂p_k in column k, 6n × parameters; SI units of y over those of p_k. Empty unless the run reached
  /// its end.
  Matrix sensitivity;
};

/// The derivatives s_k = ∂y(t₁)/∂p_k of the end state of a mass-spring system with respect to numbers of its
/// springs, by CVODES' forward sensitivity analysis: ṡ_k = J s_k + (0, M⁻¹ ∂f/∂p_k), s_k(t₀) = 0, with the
/// product J·s without assembly. The scale of p_k in its error test is the mean magnitude of the springs'
/// own numbers (1 where they are zero).
/// Throws InputError where `ivp` is no mass-spring system, where there is no parameter, and where a spring's
/// index, options or tolerances are out of range.
SolutionWithSensitivity solve_with_cvode_sensitivities(
    const Ivp& ivp, const AdaptiveStep& tolerances,
    const std::vector<mechanics::SpringParameterGroup>& parameters, const SensitivityOptions& options = {});

}  // namespace fw::oracles
