#pragma once

#include <cstdint>
#include <string>

#include "core/special_values.hpp"
#include "study/plan.hpp"
#include "study/shared_problem.hpp"

namespace fw::study {

/// The keys of [convergence].
struct ConvergenceSettings {
  double ratio = 1.5;
  std::int64_t levels = 9;
  double start_error = 0.003;
  std::int64_t max_steps = 4'000'000;
  double tolerance = 0.1;
  double minimum_correlation = 0.999;
};
void declare(settings::Archive& a, ConvergenceSettings& s);

/// A fitted order in the summary.
struct RowFit {
  double order = no_value, order_low = no_value, order_high = no_value, correlation = no_value;
  std::int64_t points = 0;
};

/// The row of the summary.
struct ConvergenceRow {
  std::string problem, method;
  std::int64_t expected_order = 0;
  RowFit all{}, position{}, velocity{};
  double reference_error = no_value;
};
void declare(SummaryRow& a, const ConvergenceRow& row);

/// One method with constant steps on one problem: errors over a ladder of steps, and the order as the slope of
/// log error over log step with its 95 % interval [Hairer, Nørsett, Wanner 1993, II.3]. Verdict: the interval
/// lies within the tolerance about the order of theory; not applicable, with the cause, where errors cannot be
/// measured, are exact, or decide nothing.
CaseResult run_convergence(const SharedProblem& problem, const std::string& call,
                           const Integrator& integrator, const ConvergenceSettings& settings,
                           const RunContext& context);

}  // namespace fw::study
