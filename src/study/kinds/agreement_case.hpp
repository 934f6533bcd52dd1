#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "study/shared_problem.hpp"

namespace fw::study {

/// The keys of [agreement].
struct AgreementSettings {
  double error = 1e-8;
  double largest_error = 1e-3;
  std::int64_t fewest_steps = 16;
  std::int64_t most_steps = 8192;
  bool has_reference = true;
};
void declare(settings::Archive& a, AgreementSettings& s);

/// A method of the study.
struct Participant {
  std::string call;
  std::shared_ptr<const Integrator> integrator;
};

/// The row of the summary.
struct AgreementRow {
  std::string problem;
  std::int64_t methods = 0, not_accurate = 0, not_applicable = 0, pairs = 0, disagreeing = 0;
  double largest_difference = 0.0, largest_ratio = 0.0;
};
void declare(SummaryRow& a, const AgreementRow& row);

/// All methods on one problem, and every pair of their solutions compared. Verdict: no two solutions differ
/// by more than their error estimates allow.
CaseResult run_agreement(const SharedProblem& problem, const std::vector<Participant>& participants,
                         const AgreementSettings& settings, const RunContext& context);

}  // namespace fw::study
