#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "analysis/fit/efficiency.hpp"
#include "study/work_precision/work_precision_case.hpp"

namespace fw::study {

namespace {

/// One point of a ladder.
struct Point {
  CaseResult* ladder = nullptr;
  double cost = 0.0;
  double error = 0.0;
};

/// All cases of one problem.
struct Ladders {
  CaseResult* front = nullptr;
  std::vector<CaseResult*> ladders;
};

/// The points of the front by the cost of that name, cheapest first.
std::vector<Point> front_by(const std::vector<CaseResult*>& ladders, const std::string& cost) {
  std::vector<Point> points;
  for (CaseResult* ladder : ladders) {
    if (ladder->columns.empty()) continue;  // ended by an exception
    const std::vector<double> costs = numbers_of(*ladder, cost), errors = numbers_of(*ladder, "error");
    for (std::size_t k = 0; k < costs.size(); ++k) points.push_back({ladder, costs[k], errors[k]});
  }
  std::vector<double> costs, errors;
  for (const Point& point : points) {
    costs.push_back(point.cost);
    errors.push_back(point.error);
  }
  const std::vector<char> flags = analysis::pareto_front(costs, errors);
  std::vector<Point> front;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (flags[k] != 0) front.push_back(points[k]);
  }
  std::stable_sort(front.begin(), front.end(),
                   [](const Point& a, const Point& b) { return a.cost < b.cost; });
  return front;
}

/// Writes one front into its case and the counts into the ladders' rows; returns its methods in order.
std::vector<std::string> fill(Ladders& problem, const std::string& cost, const std::string& unit) {
  const std::vector<Point> front = front_by(problem.ladders, cost);
  std::vector<std::string> methods, controls, distinct;
  std::vector<double> costs, errors;
  for (const Point& point : front) {
    methods.push_back(text_of(*point.ladder, "method"));
    controls.push_back(text_of(*point.ladder, "control"));
    costs.push_back(point.cost);
    errors.push_back(point.error);
    if (distinct.empty() || distinct.back() != methods.back()) distinct.push_back(methods.back());
  }
  const std::string cell = "front_points_" + cost;
  for (CaseResult* ladder : problem.ladders) {
    const auto count = std::count_if(front.begin(), front.end(),
                                     [ladder](const Point& point) { return point.ladder == ladder; });
    replace_cell(*ladder, cell, static_cast<std::int64_t>(count));
  }
  replace_cell(*problem.front, cell, static_cast<std::int64_t>(front.size()));
  const std::string prefix = "front_" + cost;
  replace_column(*problem.front, {prefix, unit, costs, {}, {}});
  replace_column(*problem.front, {prefix + "_error", "1", errors, {}, {}});
  replace_column(*problem.front, {prefix + "_method", "", methods, {}, {}});
  replace_column(*problem.front, {prefix + "_control", "", controls, {}, {}});
  return distinct;
}

std::string joined(const std::vector<std::string>& names) {
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

void conclude_fronts(StudyResult& study) {
  std::map<std::string, Ladders> problems;
  for (CaseResult& result : study.cases) {
    if (result.key.empty()) continue;  // could not be computed
    Ladders& problem = problems[text_of(result, "problem")];
    if (text_of(result, "method") == front_method) {
      problem.front = &result;
    } else {
      problem.ladders.push_back(&result);
    }
  }
  for (auto& [label, problem] : problems) {
    if (problem.front == nullptr) continue;  // not finished, or ended by an exception
    const std::vector<std::string> by_evaluations = fill(problem, "rhs_evaluations", "1");
    fill(problem, "seconds", "s");
    // Without what the machine measured: a reason is the same whenever a study runs.
    problem.front->reason =
        fmt::format("not dominated by right-hand sides, cheapest first: {}", joined(by_evaluations));
  }
}

}  // namespace fw::study
