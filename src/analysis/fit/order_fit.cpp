#include "analysis/fit/order_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/fit/power_law.hpp"

namespace fw::analysis {

namespace {

/// A finer step that gains less than this is at a floor: schemes of interest have order 1 or more.
constexpr double smallest_slope = 0.5;

/// The contiguous candidates after rules 1 and 2: [first, last).
std::pair<std::size_t, std::size_t> monotone_range(std::span<const double> errors, double floor) {
  const auto usable = [&](double e) { return std::isfinite(e) && e > 0.0 && e > floor; };
  std::size_t first = 0;
  while (first < errors.size() && !usable(errors[first])) ++first;
  std::size_t last = first;
  while (last < errors.size() && usable(errors[last])) {
    // At the coarse end an error may still rise while the solution is not resolved at all.
    if (last > first && errors[last] >= errors[last - 1]) {
      if (last - first >= static_cast<std::size_t>(minimum_fit_points)) break;
      first = last;
    }
    ++last;
  }
  return {first, last};
}

double median_of_finest(const std::vector<double>& slopes, std::size_t first, std::size_t last) {
  const std::size_t count = std::min<std::size_t>(3, last - first);
  std::vector<double> finest(slopes.begin() + static_cast<std::ptrdiff_t>(last - count),
                             slopes.begin() + static_cast<std::ptrdiff_t>(last));
  std::sort(finest.begin(), finest.end());
  return finest[finest.size() / 2];
}

}  // namespace

OrderFit fit_order(std::span<const double> steps, std::span<const double> errors, double floor,
                   double slope_tolerance) {
  OrderFit fit;
  fit.used.assign(errors.size(), 0);
  auto [first, last] = monotone_range(errors, floor);
  const auto give_up = [&](std::size_t points) {
    fit.reason = fmt::format(
        "{} of {} points are in the asymptotic range above the floor {:.2g}, expected at least {}", points,
        errors.size(), floor, minimum_fit_points);
    return fit;
  };
  if (last - first < static_cast<std::size_t>(minimum_fit_points)) return give_up(last - first);

  std::vector<double> log_step(errors.size()), log_error(errors.size()), slope(errors.size());
  for (std::size_t k = first; k < last; ++k) {
    log_step[k] = std::log(steps[k]);
    log_error[k] = std::log(errors[k]);
  }
  for (std::size_t k = first; k + 1 < last; ++k) {
    slope[k] = (log_error[k] - log_error[k + 1]) / (log_step[k] - log_step[k + 1]);
  }
  while (last - first >= 2 && slope[last - 2] < smallest_slope) --last;
  if (last - first < static_cast<std::size_t>(minimum_fit_points)) return give_up(last - first);
  double asymptotic = median_of_finest(slope, first, last - 1);
  const auto agrees = [&](std::size_t k) { return std::abs(slope[k] - asymptotic) <= slope_tolerance; };
  while (last - first > static_cast<std::size_t>(minimum_fit_points) && !agrees(last - 2)) {
    --last;
    asymptotic = median_of_finest(slope, first, last - 1);
  }
  std::size_t begin = last - 1;
  while (begin > first && agrees(begin - 1)) --begin;
  if (last - begin < static_cast<std::size_t>(minimum_fit_points)) return give_up(last - begin);

  const std::size_t n = last - begin;
  const PowerLaw law = fit_power_law(steps.subspan(begin, n), errors.subspan(begin, n));
  fit.order = law.exponent;
  fit.order_low = law.exponent_low;
  fit.order_high = law.exponent_high;
  fit.correlation = law.correlation;
  fit.points = law.points;
  std::fill(fit.used.begin() + static_cast<std::ptrdiff_t>(begin),
            fit.used.begin() + static_cast<std::ptrdiff_t>(last), char{1});
  fit.valid = true;
  return fit;
}

OrderFit fit_finest_order(std::span<const double> steps, std::span<const double> errors, double floor,
                          double slope_tolerance) {
  std::size_t end = 0;
  while (end < errors.size() && !(errors[end] <= floor)) ++end;
  std::size_t begin = end > 0 ? end - 1 : 0;
  while (begin > 0 && errors[begin - 1] > errors[begin]) --begin;
  OrderFit fit = fit_order(steps.subspan(begin, end - begin), errors.subspan(begin, end - begin), floor,
                           slope_tolerance);
  std::vector<char> used(errors.size(), 0);
  std::copy(fit.used.begin(), fit.used.end(), used.begin() + static_cast<std::ptrdiff_t>(begin));
  fit.used = std::move(used);
  return fit;
}

}  // namespace fw::analysis
