#include "analysis/fit/power_law.hpp"

#include <fmt/format.h>
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_fit.h>
#include <gsl/gsl_statistics_double.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace fw::analysis {

double PowerLaw::operator()(double x) const {
  return factor * std::pow(x, exponent);
}

PowerLaw fit_power_law(std::span<const double> x, std::span<const double> y) {
  std::vector<double> log_x, log_y;
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (!(x[k] > 0.0 && y[k] > 0.0 && std::isfinite(x[k]) && std::isfinite(y[k]))) continue;
    log_x.push_back(std::log(x[k]));
    log_y.push_back(std::log(y[k]));
  }
  PowerLaw law;
  law.points = static_cast<int>(log_x.size());
  const bool varies = !log_x.empty() && *std::min_element(log_x.begin(), log_x.end()) <
                                            *std::max_element(log_x.begin(), log_x.end());
  if (law.points < 3 || !varies) {
    law.reason = fmt::format("{} usable points, expected at least 3 at different places", law.points);
    return law;
  }
  const std::size_t n = log_x.size();
  double intercept = 0.0, cov00 = 0.0, cov01 = 0.0, cov11 = 0.0, sum_squares = 0.0;
  gsl_fit_linear(log_x.data(), 1, log_y.data(), 1, n, &intercept, &law.exponent, &cov00, &cov01, &cov11,
                 &sum_squares);
  const double half_width = gsl_cdf_tdist_Pinv(0.975, static_cast<double>(n - 2)) * std::sqrt(cov11);
  law.exponent_low = law.exponent - half_width;
  law.exponent_high = law.exponent + half_width;
  law.factor = std::exp(intercept);
  law.correlation = gsl_stats_correlation(log_x.data(), 1, log_y.data(), 1, n);
  law.valid = true;
  return law;
}

namespace {

struct Points {
  std::vector<double> log_x, gap, spread;  ///< gap = log a − log b
};

/// The only zero of gap + shift·spread; not valid if there is none or more than one.
Crossing zero_of(const Points& points, double shift) {
  Crossing crossing;
  int changes = 0;
  const auto value = [&](std::size_t k) { return points.gap[k] + shift * points.spread[k]; };
  for (std::size_t k = 0; k + 1 < points.gap.size(); ++k) {
    const double left = value(k), right = value(k + 1);
    if ((left < 0.0) == (right < 0.0)) continue;
    ++changes;
    const double weight = left / (left - right);
    crossing.x = std::exp(points.log_x[k] + weight * (points.log_x[k + 1] - points.log_x[k]));
  }
  crossing.valid = changes == 1;
  if (changes != 1) crossing.reason = fmt::format("the curves cross {} times, expected once", changes);
  return crossing;
}

}  // namespace

LawJudgement judge_exponent(const PowerLaw& law, double expected, double tolerance) {
  const bool contains = law.exponent_low <= expected && expected <= law.exponent_high;
  if (!contains && !(std::abs(law.exponent - expected) <= tolerance)) return LawJudgement::refuted;
  const bool is_narrow =
      law.exponent_low >= expected - decisive_distance && law.exponent_high <= expected + decisive_distance;
  return is_narrow ? LawJudgement::supported : LawJudgement::open;
}

Crossing find_crossing(std::span<const double> x, std::span<const double> a, std::span<const double> b,
                       std::span<const double> spread_a, std::span<const double> spread_b) {
  Points points;
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (!(x[k] > 0.0 && a[k] > 0.0 && b[k] > 0.0 && std::isfinite(a[k]) && std::isfinite(b[k]))) continue;
    points.log_x.push_back(std::log(x[k]));
    points.gap.push_back(std::log(a[k]) - std::log(b[k]));
    points.spread.push_back(std::log(spread_a[k]) + std::log(spread_b[k]));
  }
  Crossing crossing = zero_of(points, 0.0);
  if (!crossing.valid) return crossing;
  const Crossing up = zero_of(points, 1.0), down = zero_of(points, -1.0);
  // Where a shifted curve does not cross at all, nothing but the range that was measured bounds the crossing.
  const double first = std::exp(points.log_x.front()), last = std::exp(points.log_x.back());
  const bool falls = points.gap.front() > 0.0;
  const double at_up = up.valid ? up.x : (falls ? last : first);
  const double at_down = down.valid ? down.x : (falls ? first : last);
  crossing.low = std::min(at_up, at_down);
  crossing.high = std::max(at_up, at_down);
  return crossing;
}

}  // namespace fw::analysis
