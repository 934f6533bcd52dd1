#pragma once

#include <memory>
#include <string>
#include <vector>

#include "study/measure/timed_run.hpp"
#include "study/shared_problem.hpp"

namespace fw::study {

/// The keys of [work_precision].
struct WorkPrecisionSettings {
  std::int64_t levels = 14;       ///< rungs of a ladder at most
  double step_ratio = 1.5;        ///< of successive constant steps
  double tolerance_ratio = 10.0;  ///< of successive tolerances
  std::int64_t fewest_steps = 8;  ///< where the search for the coarsest step begins
  double start_error = 0.3;       ///< relative error at the coarsest step, found by doubling
  double finest_error = 1e-12;    ///< a ladder ends below
  double first_tolerance = 1e-2;  ///< relative
  double smallest_tolerance = 1e-13;
  double absolute_over_relative = 1e-2;      ///< absolute tolerance in units of the relative one
  std::int64_t max_evaluations = 50'000;     ///< right-hand sides of a run
  std::int64_t max_factorisations = 20'000;  ///< of a run; a ladder ends where the next one would need more
  double target_error = 1e-4;                ///< relative: at which costs are compared
  double fit_error = 3e-3;                   ///< relative: larger errors are no part of the fit
  double tolerance = 0.15;                   ///< |efficiency order − order| that still holds
  TimingRule timing;
};
void declare(settings::Archive& a, WorkPrecisionSettings& settings);

/// How a method's steps are chosen in a case.
enum class LadderControl { fixed, adaptive };

/// "fixed", "adaptive".
std::string to_string(LadderControl control);

/// What a case runs.
struct WorkPrecisionSpec {
  std::shared_ptr<const SharedProblem> problem;
  std::string call;
  std::shared_ptr<const Integrator> integrator;
  LadderControl control = LadderControl::fixed;
  WorkPrecisionSettings settings;
};

/// Runs the ladder and fits the efficiency order.
CaseResult run_work_precision(const WorkPrecisionSpec& spec, const RunContext& context);

/// The columns of the summary.
std::vector<SummaryColumn> work_precision_summary();

/// What stands for the method in the row of a front.
inline const std::string front_method = "Pareto front";

/// The case that holds a problem's Pareto fronts, empty until `conclude_fronts` fills it.
CaseResult empty_front(const StudyProblem& problem);

/// Fills the fronts of every problem, by right-hand sides and by seconds, and counts in every ladder's row
/// how many of its points are on them.
void conclude_fronts(StudyResult& study);

}  // namespace fw::study
