#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "analysis/fit/power_law.hpp"
#include "analysis/theory/stiffness_measures.hpp"
#include "core/special_values.hpp"
#include "study/measure/error_meter.hpp"
#include "study/stiffness/stiffness_cases.hpp"

namespace fw::study {

namespace {

/// The cheapest method of a class at every member.
struct Cheapest {
  std::vector<double> cost, spread;
  std::vector<std::string> method;
};

Cheapest cheapest_of(const std::vector<const CaseResult*>& cases, const std::string& stepping,
                     const std::string& cost, std::size_t members) {
  Cheapest best{std::vector<double>(members, no_value), std::vector<double>(members, no_value),
                std::vector<std::string>(members)};
  for (const CaseResult* result : cases) {
    if (text_of(*result, "stepping") != stepping) continue;
    const std::vector<double> costs = numbers_of(*result, cost),
                              spreads = numbers_of(*result, cost + "_spread");
    for (std::size_t k = 0; k < std::min(members, costs.size()); ++k) {
      if (!std::isfinite(costs[k]) || costs[k] >= best.cost[k])
        continue;  // false against NaN: the first is taken
      best.cost[k] = costs[k];
      best.spread[k] = spreads[k];
      best.method[k] = text_of(*result, "method");
    }
  }
  return best;
}

/// Adds the cheapest curves by one measure of cost and their crossing; returns it in words.
std::string cross(CaseResult& overview, const std::vector<const CaseResult*>& cases, const std::string& cost,
                  const std::string& unit, const std::string& name) {
  std::vector<double> values = numbers_of(overview, "parameter");
  for (double& value : values) value = std::abs(value);  // a decay rate may be negative
  const Cheapest plain = cheapest_of(cases, "explicit", cost, values.size());
  const Cheapest implicit = cheapest_of(cases, "implicit", cost, values.size());
  for (const auto& [stepping, curve] : {std::pair{"explicit", &plain}, {"implicit", &implicit}}) {
    const std::string prefix = fmt::format("cheapest_{}_{}", stepping, cost);
    replace_column(overview, {prefix, unit, curve->cost, {}, {}});
    replace_column(overview, {prefix + "_spread", "1", curve->spread, {}, {}});
    replace_column(overview, {prefix + "_method", "", curve->method, {}, {}});
  }
  const analysis::Crossing crossing =
      analysis::find_crossing(values, plain.cost, implicit.cost, plain.spread, implicit.spread);
  const std::string cell = "crossing_" + cost;
  replace_cell(overview, cell, crossing.valid ? crossing.x : no_value);
  replace_cell(overview, cell + "_low", crossing.valid ? crossing.low : no_value);
  replace_cell(overview, cell + "_high", crossing.valid ? crossing.high : no_value);
  if (!crossing.valid) return fmt::format("by {} {}", name, crossing.reason);
  return fmt::format("by {} implicit pays from {:.3g} [{:.3g}, {:.3g}]", name, crossing.x, crossing.low,
                     crossing.high);
}

/// All cost cases of a family and its overview.
struct Family {
  CaseResult* overview = nullptr;
  std::vector<const CaseResult*> costs;
};

std::string index_in_words(const CaseResult& overview) {
  const std::vector<double> index = numbers_of(overview, "stiffness_index");
  const auto [least, most] = std::minmax_element(index.begin(), index.end());
  return fmt::format("stiffness index max|lambda| T from {:.3g} to {:.3g}", *least, *most);
}

}  // namespace

CaseResult run_stiffness_overview(const StiffnessFamily& family, const RunContext& context) {
  std::vector<double> largest, index, ratio, spread;
  for (const auto& member : family.members) {
    const Ivp& ivp = member->ivp();
    analysis::StiffnessMeasures measures = analysis::stiffness_measures(*ivp.system, ivp.t0, ivp.y0);
    const ErrorMeter meter(*member, context);
    if (meter.status().ok()) {
      const analysis::StiffnessMeasures end =
          analysis::stiffness_measures(*ivp.system, ivp.t1, meter.end_state());
      measures.largest_eigenvalue = std::max(measures.largest_eigenvalue, end.largest_eigenvalue);
      measures.stiffness_ratio = std::fmax(measures.stiffness_ratio, end.stiffness_ratio);
      measures.eigenvalue_ratio = std::fmax(measures.eigenvalue_ratio, end.eigenvalue_ratio);
    }
    largest.push_back(measures.largest_eigenvalue);
    index.push_back(measures.largest_eigenvalue * (ivp.t1 - ivp.t0));
    ratio.push_back(measures.stiffness_ratio);
    spread.push_back(measures.eigenvalue_ratio);
  }
  CaseResult result;
  result.columns = {{"parameter", "SI", family.values, {}, {{"name", family.parameter}}},
                    {"largest_eigenvalue", "1/s", largest, {}, {}},
                    {"stiffness_index", "1", index, {}, {}},
                    {"stiffness_ratio", "1", ratio, {}, {}},
                    {"eigenvalue_ratio", "1", spread, {}, {}}};
  result.reason = index_in_words(result);
  result.summary = cells_of(StiffnessRow{.problem = family.label,
                                         .method = "overview",
                                         .measure = measures_overview,
                                         .stepping = "",
                                         .parameter = family.parameter,
                                         .points = static_cast<std::int64_t>(family.members.size())});
  return result;
}

void conclude_stiffness(StudyResult& study) {
  std::map<std::string, Family> families;
  for (CaseResult& result : study.cases) {
    if (result.columns.empty()) continue;  // ended by an exception
    Family& family = families[text_of(result, "problem")];
    if (text_of(result, "measure") == measures_overview) family.overview = &result;
    if (text_of(result, "measure") == measures_cost) family.costs.push_back(&result);
  }
  for (auto& [label, family] : families) {
    if (family.overview == nullptr || family.costs.empty()) continue;
    const std::string by_cost = cross(*family.overview, family.costs, "cost", "1", "operations");
    cross(*family.overview, family.costs, "seconds", "s", "seconds");
    // Without what the machine measured: a reason is the same whenever a study runs.
    family.overview->reason = fmt::format("{}; {}", index_in_words(*family.overview), by_cost);
  }
}

}  // namespace fw::study
