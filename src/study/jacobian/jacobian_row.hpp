#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "study/summary_row.hpp"

namespace fw::study {

/// The summary's row of a case of kind `jacobian`; NaN and 0 where a figure does not apply to its part.
struct JacobianRow {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();

  std::string subject;  ///< the random springs' or the problem's label
  std::string part;     ///< "derivative", "pattern", "definiteness" or "runs"
  std::string variant;  ///< the formula, the tangent model or the method
  std::int64_t unknowns = 0;
  std::int64_t samples = 0;
  // derivative
  double deviation = none, least_deviation = none, deviation_damping = none;
  double largest_difference = none, predicted_difference = none;
  double truncation_slope = none, rounding_slope = none, best_increment = none, best_deviation = none;
  // pattern
  std::int64_t entries = 0;
  double filled = none;
  // definiteness
  double smallest_eigenvalue = none, indefinite = none, limit_step = none, predicted_limit_step = none;
  double newton_iterations = none, newton_failures = none, newton_cg_failures = none;
  double cg_iterations = none, cg_failures = none;
  // runs
  double compression = none, largest_gain = none, worst_step = none, failed_runs = none;
};

void declare(SummaryRow& a, const JacobianRow& row);

}  // namespace fw::study
