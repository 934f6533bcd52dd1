#include "analysis/verification/verification.hpp"

#include <exception>

namespace fw::analysis {

const std::vector<VerificationPart>& verification_parts() {
  static const std::vector<VerificationPart> parts = {
      {"order", verify_order},
      {"error_estimate", verify_error_estimate},
      {"dense_output", verify_dense_output},
      {"frames", verify_frames},
      {"step_control", verify_step_control},
      {"tolerance_proportionality", verify_tolerance_proportionality},
      {"polynomial_exactness", verify_polynomial_exactness},
      {"tableau", verify_tableau},
      {"evaluation_count", verify_evaluation_count},
      {"stability_function", verify_stability_function},
      {"stability_limits", verify_stability_limits},
      {"symplecticity", verify_symplecticity},
      {"reversibility", verify_reversibility},
      {"conservation", verify_conservation},
      {"agreement", verify_agreement},
  };
  return parts;
}

void run_part(const VerificationPart& part, const SchemeUnderTest& scheme,
              std::vector<PropertyCheck>& checks) {
  try {
    part.check(scheme, checks);
  } catch (const std::exception& error) {
    checks.push_back({.property = part.name, .verdict = Verdict::fails, .reason = error.what()});
  }
}

std::vector<PropertyCheck> verify(const SchemeUnderTest& scheme) {
  std::vector<PropertyCheck> checks;
  for (const VerificationPart& part : verification_parts()) run_part(part, scheme, checks);
  return checks;
}

}  // namespace fw::analysis
