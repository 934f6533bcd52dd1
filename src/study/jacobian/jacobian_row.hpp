#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "core/special_values.hpp"
#include "study/summary_row.hpp"

namespace fw::study {

/// The summary's row of a case of kind `jacobian`; NaN and 0 where a figure does not apply to its part.
struct JacobianRow {
  std::string subject;  ///< the random springs' or the problem's label
  std::string part;     ///< "derivative", "pattern", "definiteness" or "runs"
  std::string variant;  ///< the formula, the tangent model or the method
  std::int64_t unknowns = 0;
  std::int64_t samples = 0;
  // derivative
  double deviation = no_value, least_deviation = no_value, deviation_damping = no_value;
  double largest_difference = no_value, predicted_difference = no_value;
  double truncation_slope = no_value, rounding_slope = no_value, best_increment = no_value,
         best_deviation = no_value;
  // pattern
  std::int64_t entries = 0;
  double filled = no_value;
  // definiteness
  double smallest_eigenvalue = no_value, indefinite = no_value, limit_step = no_value,
         predicted_limit_step = no_value;
  double newton_iterations = no_value, newton_failures = no_value, newton_cg_failures = no_value;
  double cg_iterations = no_value, cg_failures = no_value;
  // runs
  double compression = no_value, largest_gain = no_value, worst_step = no_value, failed_runs = no_value;
};

void declare(SummaryRow& a, const JacobianRow& row);

}  // namespace fw::study
