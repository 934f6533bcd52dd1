#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/special_values.hpp"
#include "schemes/scheme_data.hpp"
#include "study/measure/timed_run.hpp"
#include "study/measure/work_columns.hpp"
#include "study/shared_problem.hpp"

namespace fw::study {

/// The keys of [stiffness].
struct StiffnessSettings {
  // Cost at a given accuracy.
  double target_error = 1e-2;              ///< relative
  std::int64_t fewest_steps = 8;           ///< where the search begins; the map's coarsest step as well
  std::int64_t max_evaluations = 500'000;  ///< right-hand sides of a run
  double bracket = 1.05;                   ///< the number of steps is found to this factor
  double first_tolerance = 0.1;            ///< relative, of adaptive methods
  double smallest_tolerance = 1e-10;
  double tolerance_ratio = 2.0;
  double absolute_over_relative = 1e-2;
  double fit_range = 10.0;  ///< the exponent is fitted where |λ| is at most this factor below its largest
  double exponent_tolerance = 0.1;  ///< |exponent − 1| of steps over |λ| that still holds
  double cost_uncertainty = 2.0;    ///< factor by which the declared operation costs may be off
  OperationCosts costs;
  TimingRule timing;
  // Orders over step and stiffness.
  std::int64_t map_levels = 9;    ///< steps, each half the one before
  double stiff_product = 100.0;   ///< h|λ| above counts as stiff
  double nonstiff_product = 0.5;  ///< h|λ| below counts as not stiff
  double order_tolerance = 0.15;  ///< |observed − predicted order| that still holds
};
void declare(settings::Archive& a, StiffnessSettings& settings);

/// Members of a family, with the values of what is varied.
struct StiffnessFamily {
  std::string label;
  std::string parameter;
  std::vector<double> values;
  std::vector<std::shared_ptr<const SharedProblem>> members;
  bool is_prothero_robinson = false;  ///< the theory of stiff orders applies
};

/// A method as a case knows it.
struct StiffnessMethod {
  std::string call;
  std::shared_ptr<const Integrator> integrator;
  schemes::SchemeData data;
};

/// What a case measures: the entries of the column `measure`.
inline const std::string measures_cost = "cost", measures_orders = "orders", measures_overview = "overview";

/// The cells of every row; what does not apply stays as it is here.
struct StiffnessRow {
  /// A number with its 95 % interval.
  struct Figure {
    double value = no_value, low = no_value, high = no_value;
  };
  std::string problem, method, measure, stepping, parameter;
  std::int64_t points = 0;
  Figure step_exponent{};
  std::int64_t classical_order = 0;
  Figure nonstiff_order{};
  double predicted_stiff_order = no_value;
  Figure stiff_order{};
  Figure crossing_cost{}, crossing_seconds{};
};

void declare(SummaryRow& a, const StiffnessRow& row);

/// The cost of the target error for every member.
CaseResult run_stiffness_cost(const StiffnessFamily& family, const StiffnessMethod& method,
                              const StiffnessSettings& settings, const RunContext& context);

/// The errors and local orders over steps and members.
CaseResult run_order_map(const StiffnessFamily& family, const StiffnessMethod& method,
                         const StiffnessSettings& settings, const RunContext& context);

/// The stiffness measures of every member; `conclude_stiffness` adds the crossings.
CaseResult run_stiffness_overview(const StiffnessFamily& family, const RunContext& context);

/// Fills the cheapest explicit and implicit method of every member and the crossings into the overviews.
void conclude_stiffness(StudyResult& study);

}  // namespace fw::study
