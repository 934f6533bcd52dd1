#include <fmt/format.h>

#include "study/stiffness/stiffness_cases.hpp"

namespace fw::study {

std::string StiffnessSettings::text() const {
  return fmt::format(
             "target_error = {}\nfewest_steps = {}\nmax_evaluations = {}\nbracket = {}\nfirst_tolerance = "
             "{}\nsmallest_tolerance = {}\ntolerance_ratio = {}\nabsolute_over_relative = "
             "{}\nfit_range = {}\nexponent_tolerance = {}\ncost_uncertainty = {}\n",
             target_error, fewest_steps, max_evaluations, bracket, first_tolerance, smallest_tolerance,
             tolerance_ratio, absolute_over_relative, fit_range, exponent_tolerance, cost_uncertainty) +
         fmt::format(
             "jacobian = {}\njacobian_product = {}\nfactorisation = {}\nlinear_solve = {}\nlinear_iteration "
             "= {}\nrepetitions = {}\nshortest_sample = {}\nlongest_timing = {}\n",
             costs.jacobian, costs.jacobian_product, costs.factorisation, costs.linear_solve,
             costs.linear_iteration, timing.repetitions, timing.shortest_sample, timing.longest_total) +
         fmt::format("map_levels = {}\nstiff_product = {}\nnonstiff_product = {}\norder_tolerance = {}\n",
                     map_levels, stiff_product, nonstiff_product, order_tolerance);
}

void add_stiffness_summary(CaseResult& result, const StiffnessRow& row) {
  result.summary = {{"problem", "", row.problem},     {"method", "", row.method},
                    {"measure", "", row.measure},     {"stepping", "", row.stepping},
                    {"parameter", "", row.parameter}, {"points", "1", row.points}};
  const auto add = [&result](const std::string& name, const std::string& unit,
                             const StiffnessRow::Figure& figure) {
    result.summary.push_back({name, unit, figure.value});
    result.summary.push_back({name + "_low", unit, figure.low});
    result.summary.push_back({name + "_high", unit, figure.high});
  };
  add("step_exponent", "1", row.step_exponent);
  result.summary.push_back({"classical_order", "1", row.classical_order});
  add("nonstiff_order", "1", row.nonstiff_order);
  result.summary.push_back({"predicted_stiff_order", "1", row.predicted_stiff_order});
  add("stiff_order", "1", row.stiff_order);
  add("crossing_cost", "SI", row.crossing_cost);
  add("crossing_seconds", "SI", row.crossing_seconds);
  result.summary.push_back({"verdict", "", std::string(to_string(result.verdict))});
  result.summary.push_back({"reason", "", result.reason});
}

}  // namespace fw::study
