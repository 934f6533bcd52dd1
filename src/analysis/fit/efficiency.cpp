#include "analysis/fit/efficiency.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace fw::analysis {

namespace {

bool is_usable(double cost, double error) {
  return cost > 0.0 && error > 0.0 && std::isfinite(cost) && std::isfinite(error);
}

}  // namespace

std::vector<char> pareto_front(std::span<const double> costs, std::span<const double> errors) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < costs.size(); ++k) {
    if (is_usable(costs[k], errors[k])) order.push_back(k);
  }
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    return costs[i] != costs[j] ? costs[i] < costs[j] : errors[i] < errors[j];
  });
  std::vector<char> on_front(costs.size(), 0);
  double best_error = std::numeric_limits<double>::infinity(), best_cost = 0.0;
  for (const std::size_t k : order) {
    // A point equal to the last one of the front is not dominated by it.
    if (errors[k] < best_error || (errors[k] == best_error && costs[k] == best_cost)) {
      on_front[k] = 1;
      best_error = errors[k];
      best_cost = costs[k];
    }
  }
  return on_front;
}

double cost_at_error(std::span<const double> costs, std::span<const double> errors, double target) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::size_t> usable;
  for (std::size_t k = 0; k < costs.size(); ++k) {
    if (is_usable(costs[k], errors[k])) usable.push_back(k);
  }
  double cheapest = std::numeric_limits<double>::infinity(), cheapest_run = cheapest;
  bool all_reach = true;
  for (std::size_t i = 0; i < usable.size(); ++i) {
    const std::size_t k = usable[i];
    all_reach = all_reach && errors[k] <= target;
    cheapest_run = std::min(cheapest_run, costs[k]);
    if (errors[k] == target) cheapest = std::min(cheapest, costs[k]);
    if (i == 0) continue;
    const std::size_t j = usable[i - 1];
    if (!(errors[j] > target && errors[k] < target)) continue;
    const double weight = std::log(errors[j] / target) / std::log(errors[j] / errors[k]);
    cheapest = std::min(cheapest, costs[j] * std::pow(costs[k] / costs[j], weight));
  }
  if (usable.empty()) return none;
  if (all_reach) return cheapest_run;
  return std::isfinite(cheapest) ? cheapest : none;
}

}  // namespace fw::analysis
