#include "analysis/fit/binned_series.hpp"
#include "core/special_values.hpp"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_fit.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace fw::analysis {

namespace {}

BinnedSeries::BinnedSeries(std::uint64_t total, std::uint64_t bins) : total_(total) {
  if (total == 0 || bins == 0) throw std::logic_error("BinnedSeries: expected values and bins");
  const auto count = static_cast<std::size_t>(std::min(total, bins));
  counts_.assign(count, 0);
  time_sums_.assign(count, 0.0);
  sums_.assign(count, 0.0);
  least_.assign(count, no_value);
  largest_.assign(count, no_value);
}

void BinnedSeries::add(double time, double value) {
  const auto bins = static_cast<std::uint64_t>(counts_.size());
  // 128 bits: 2⁵³ steps times bins does not fit into 64.
  const auto bin = static_cast<std::size_t>(std::min<std::uint64_t>(
      bins - 1, static_cast<std::uint64_t>(static_cast<__uint128_t>(count_) * bins / total_)));
  ++counts_[bin];
  time_sums_[bin] += time;
  sums_[bin] += value;
  least_[bin] = std::fmin(least_[bin], value);
  largest_[bin] = std::fmax(largest_[bin], value);
  largest_magnitude_ = std::max(largest_magnitude_, std::abs(value));

  ++count_;
  const auto n = static_cast<double>(count_);
  const double time_step = time - mean_time_, value_step = value - mean_value_;
  mean_time_ += time_step / n;
  mean_value_ += value_step / n;
  time_moment_ += time_step * (time - mean_time_);
  value_moment_ += value_step * (value - mean_value_);
  mixed_moment_ += time_step * (value - mean_value_);
}

std::vector<double> BinnedSeries::times() const {
  std::vector<double> means;
  for (std::size_t k = 0; k < counts_.size(); ++k) {
    means.push_back(counts_[k] == 0 ? no_value : time_sums_[k] / static_cast<double>(counts_[k]));
  }
  return means;
}

std::vector<double> BinnedSeries::means() const {
  std::vector<double> means;
  for (std::size_t k = 0; k < counts_.size(); ++k) {
    means.push_back(counts_[k] == 0 ? no_value : sums_[k] / static_cast<double>(counts_[k]));
  }
  return means;
}

double BinnedSeries::correlation() const {
  return mixed_moment_ / std::sqrt(time_moment_ * value_moment_);
}

double BinnedSeries::slope() const {
  return mixed_moment_ / time_moment_;
}

double Drift::significance() const {
  const double change = std::abs(slope) * duration;
  return change == 0.0 ? 0.0 : change / oscillation;
}

bool Drift::has_long_batches() const {
  constexpr double lower_bound = 1.2;
  const double trend_in_batch = 0.5 * std::abs(slope) * duration / static_cast<double>(batches - 1);
  return oscillation > 2.0 * trend_in_batch && independence >= lower_bound;
}

bool Drift::is_significant(std::size_t tests) const {
  const double quantile =
      gsl_cdf_tdist_Pinv(1.0 - 0.025 / static_cast<double>(tests), static_cast<double>(batches - 2));
  return std::abs(slope) > quantile * standard_error;
}

Drift fit_drift(const BinnedSeries& series, std::uint64_t batches) {
  const std::vector<double> bin_times = series.times(), bin_means = series.means();
  const auto bins = static_cast<std::uint64_t>(bin_means.size());
  const std::uint64_t used = std::min(batches, bins);
  std::vector<double> times, means, halves;
  for (std::uint64_t b = 0; b < used; ++b) {
    double time = 0.0, mean = 0.0, least = no_value, largest = no_value;
    std::uint64_t members = 0;
    for (std::uint64_t k = b * bins / used; k < (b + 1) * bins / used; ++k) {
      if (!std::isfinite(bin_means[k])) continue;
      time += bin_times[k];
      mean += bin_means[k];
      least = std::fmin(least, series.least()[k]);
      largest = std::fmax(largest, series.largest()[k]);
      ++members;
    }
    if (members == 0) continue;
    times.push_back(time / static_cast<double>(members));
    means.push_back(mean / static_cast<double>(members));
    halves.push_back(0.5 * (largest - least));
  }
  Drift drift;
  const std::size_t n = times.size();
  if (n < 4) return drift;
  drift.valid = true;
  double intercept = 0.0, cov00 = 0.0, cov01 = 0.0, cov11 = 0.0, sum_squares = 0.0;
  gsl_fit_linear(times.data(), 1, means.data(), 1, n, &intercept, &drift.slope, &cov00, &cov01, &cov11,
                 &sum_squares);
  double squares = 0.0, differences = 0.0, before = 0.0;
  for (std::size_t b = 0; b < n; ++b) {
    const double residual = means[b] - intercept - drift.slope * times[b];
    squares += residual * residual;
    if (b > 0) differences += (residual - before) * (residual - before);
    before = residual;
  }
  if (squares > 0.0) drift.independence = differences / squares;
  drift.batches = static_cast<int>(n);
  drift.standard_error = std::sqrt(cov11);
  const double half_width = gsl_cdf_tdist_Pinv(0.975, static_cast<double>(n - 2)) * drift.standard_error;
  drift.slope_low = drift.slope - half_width;
  drift.slope_high = drift.slope + half_width;
  drift.duration = times.back() - times.front();
  std::nth_element(halves.begin(), halves.begin() + static_cast<std::ptrdiff_t>(n / 2), halves.end());
  drift.oscillation = halves[n / 2];
  return drift;
}

}  // namespace fw::analysis
