#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/fit/measured_oscillation.hpp"
#include "problems/problem.hpp"
#include "study/plan.hpp"

namespace fw::study {

/// The keys of [dissipation].
struct DissipationSettings {
  double mass = 2.0, stiffness = 7.0;
  double from = 0.05, to = 20.0;
  std::int64_t count = 61;
  double periods = 10.0;
  std::int64_t transient_steps = 400;
  double shown_steps_per_period = 20.0;
  double shown_periods = 5.0;
  double infinity = 1e5;
  double tolerance = 1e-8;

  /// The values of z = ωh.
  std::vector<double> grid() const;
  /// z of the motion that is kept.
  double shown() const;
};
void declare(settings::Archive& a, DissipationSettings& s);

/// The row of the summary.
struct DissipationRow {
  std::string method;
  double steps_per_period = 0.0, damping_ratio = 0.0, period_error = 0.0;
  double radius_at_infinity = 0.0, measured_radius_at_infinity = 0.0, largest_difference = 0.0;
  std::int64_t compared = 0;
};
void declare(SummaryRow& a, const DissipationRow& row);

/// One method on a single spring: damping ratio and period error over ωh by theory (empty where there is
/// none) and of runs. Verdict: the measured factor per step is the predicted one; without theory, that of a
/// symplectic method has modulus 1.
CaseResult run_dissipation(const std::string& call, const Integrator& integrator,
                           const analysis::AmplificationFactors& theory, const Problem& spring,
                           const DissipationSettings& settings, const RunContext& context);

}  // namespace fw::study
