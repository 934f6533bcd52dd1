#include "study/jacobian/jacobian_row.hpp"

namespace fw::study {

void declare(SummaryRow& a, const JacobianRow& row) {
  a("subject", "", row.subject, "law of the random springs, or the problem's label");
  a("part", "", row.part, "`derivative`, `pattern`, `definiteness`, `runs`");
  a("variant", "", row.variant, "formula, size of the blocks, tangent model or method");
  a("unknowns", "1", row.unknowns, "size of the state (derivatives) or of the matrix");
  a("samples", "1", row.samples, "samples, points of the grid, or runs");
  a("deviation", "1", row.deviation, "largest; NaN where a figure is not of the part, like all that follow");
  a("least_deviation", "1", row.least_deviation, "least over the samples");
  a("deviation_damping", "1", row.deviation_damping, "largest, of D");
  a("largest_difference", "SI", row.largest_difference, "");
  a("predicted_difference", "N/m", row.predicted_difference, "largest");
  a("truncation_slope", "1", row.truncation_slope,
    "of the error over the increment, fitted from ten times the best increment to 0.01");
  a("rounding_slope", "1", row.rounding_slope, "fitted from 1e-13 to a tenth of the best increment");
  a("best_increment", "1", row.best_increment, "where the error is least");
  a("best_deviation", "1", row.best_deviation, "that error");
  a("entries", "1", row.entries, "of the pattern; else 0");
  a("filled", "1", row.filled, "their share of the matrix");
  a("smallest_eigenvalue", "kg", row.smallest_eigenvalue, "of A over the grid");
  a("indefinite", "1", row.indefinite, "share of the grid where A is not positive definite");
  a("limit_step", "s", row.limit_step, "least over the compressions");
  a("predicted_limit_step", "s", row.predicted_limit_step, "likewise");
  a("newton_iterations", "1", row.newton_iterations, "mean where it converges");
  a("newton_failures", "1", row.newton_failures, "points of the grid");
  a("newton_cg_failures", "1", row.newton_cg_failures, "likewise");
  a("cg_iterations", "1", row.cg_iterations, "mean where it converges");
  a("cg_failures", "1", row.cg_failures, "points of the grid");
  a("compression", "1", row.compression, "of runs");
  a("largest_gain", "1", row.largest_gain, "over the steps");
  a("worst_step", "s", row.worst_step, "where it is; NaN: no gain");
  a("failed_runs", "1", row.failed_runs, "that did not reach the end");
}

}  // namespace fw::study
