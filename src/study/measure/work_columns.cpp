#include "study/measure/work_columns.hpp"

#include <string>
#include <utility>

namespace fw::study {

void add_work_columns(std::vector<Column>& columns, std::span<const Work> runs) {
  const std::pair<std::string, std::uint64_t Work::*> counters[] = {
      {"rhs_evaluations", &Work::rhs_evaluations},     {"jacobian_evaluations", &Work::jacobian_evaluations},
      {"jacobian_products", &Work::jacobian_products}, {"factorisations", &Work::factorisations},
      {"linear_solves", &Work::linear_solves},         {"linear_iterations", &Work::linear_iterations},
      {"newton_iterations", &Work::newton_iterations}, {"accepted_steps", &Work::accepted_steps},
      {"rejected_steps", &Work::rejected_steps},
  };
  for (const auto& [name, counter] : counters) {
    std::vector<std::int64_t> counts;
    counts.reserve(runs.size());
    for (const Work& work : runs) counts.push_back(static_cast<std::int64_t>(work.*counter));
    columns.push_back({name, "1", std::move(counts), {}, {}});
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

}  // namespace fw::study
