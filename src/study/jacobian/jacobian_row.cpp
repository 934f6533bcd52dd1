#include "study/jacobian/jacobian_row.hpp"

namespace fw::study {

void add_summary(const JacobianRow& row, CaseResult& result) {
  result.summary = {{"subject", "", row.subject},
                    {"part", "", row.part},
                    {"variant", "", row.variant},
                    {"unknowns", "1", row.unknowns},
                    {"samples", "1", row.samples},
                    {"deviation", "1", row.deviation},
                    {"least_deviation", "1", row.least_deviation},
                    {"deviation_damping", "1", row.deviation_damping},
                    {"largest_difference", "SI", row.largest_difference},
                    {"predicted_difference", "N/m", row.predicted_difference},
                    {"truncation_slope", "1", row.truncation_slope},
                    {"rounding_slope", "1", row.rounding_slope},
                    {"best_increment", "1", row.best_increment},
                    {"best_deviation", "1", row.best_deviation},
                    {"entries", "1", row.entries},
                    {"filled", "1", row.filled},
                    {"smallest_eigenvalue", "kg", row.smallest_eigenvalue},
                    {"indefinite", "1", row.indefinite},
                    {"limit_step", "s", row.limit_step},
                    {"predicted_limit_step", "s", row.predicted_limit_step},
                    {"newton_iterations", "1", row.newton_iterations},
                    {"newton_failures", "1", row.newton_failures},
                    {"newton_cg_failures", "1", row.newton_cg_failures},
                    {"cg_iterations", "1", row.cg_iterations},
                    {"cg_failures", "1", row.cg_failures},
                    {"compression", "1", row.compression},
                    {"largest_gain", "1", row.largest_gain},
                    {"worst_step", "s", row.worst_step},
                    {"failed_runs", "1", row.failed_runs},
                    {"verdict", "", std::string(to_string(result.verdict))},
                    {"reason", "", result.reason}};
}

}  // namespace fw::study
