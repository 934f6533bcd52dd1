#include "study/measure/work_columns.hpp"

#include <utility>

#include "core/work_counters.hpp"

namespace fw::study {

void add_work_columns(std::vector<Column>& columns, std::span<const Work> runs) {
  for (const WorkCounter& counter : work_counters) {
    std::vector<std::int64_t> counts;
    counts.reserve(runs.size());
    for (const Work& work : runs) counts.push_back(static_cast<std::int64_t>(work.*counter.count));
    columns.push_back({counter.name, "1", std::move(counts), {}, {}});
  }
}

double OperationCosts::of(const Work& work) const {
  const auto count = [](std::uint64_t n) { return static_cast<double>(n); };
  const double solves = work.linear_iterations > 0 ? linear_iteration * count(work.linear_iterations)
                                                   : linear_solve * count(work.linear_solves);
  return count(work.rhs_evaluations) + jacobian * count(work.jacobian_evaluations) +
         jacobian_product * count(work.jacobian_products) + factorisation * count(work.factorisations) +
         solves;
}

void declare(settings::Archive& a, OperationCosts& costs) {
  const auto cost = [&a](const char* name, double& value, const char* doc) {
    a(settings::setting(name, value).unit("1").nonnegative().doc(doc));
  };
  cost("jacobian", costs.jacobian, "assembling J or the tangent matrices");
  cost("jacobian_product", costs.jacobian_product, "");
  cost("factorisation", costs.factorisation, "");
  cost("linear_solve", costs.linear_solve, "with a factorisation at hand");
  cost("linear_iteration", costs.linear_iteration, "");
}

}  // namespace fw::study
