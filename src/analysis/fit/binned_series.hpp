#pragma once

#include <cstdint>
#include <vector>

#include "core/types.hpp"

namespace fw::analysis {

/// A series of `total` values that comes in one by one, decimated into bins of equal numbers of values:
/// least, largest and mean value of each. Needs memory for the bins only.
class BinnedSeries {
 public:
  /// At most `bins` bins, fewer where there are fewer values. Throws std::logic_error unless both are > 0.
  BinnedSeries(std::uint64_t total, std::uint64_t bins);

  /// The next value and where it was taken; more than `total` are put into the last bin.
  void add(double time, double value);

  /// Of every bin; NaN of bins that no value has reached.
  std::vector<double> times() const;  ///< means
  std::vector<double> means() const;
  const std::vector<double>& least() const { return least_; }
  const std::vector<double>& largest() const { return largest_; }

  std::uint64_t count() const { return count_; }
  /// Pearson's r of time and value over all values; NaN where one of them does not vary.
  double correlation() const;
  /// The least-squares slope of the values over time; NaN likewise.
  double slope() const;
  /// The largest |value|.
  double largest_magnitude() const { return largest_magnitude_; }

 private:
  std::uint64_t total_;
  std::vector<std::uint64_t> counts_;
  std::vector<double> time_sums_, sums_, least_, largest_;
  std::uint64_t count_ = 0;
  double mean_time_ = 0.0, mean_value_ = 0.0;  ///< running moments [Welford 1962]
  double time_moment_ = 0.0, value_moment_ = 0.0, mixed_moment_ = 0.0;
  double largest_magnitude_ = 0.0;
};

/// A secular trend and the oscillation about it.
struct Drift {
  bool valid = false;      ///< at least four batches hold values
  double slope = 0.0;      ///< of the batch means over time
  double slope_low = 0.0;  ///< 95 % interval, Student's t with (batches − 2) degrees of freedom
  double slope_high = 0.0;
  double oscillation = 0.0;     ///< the median over the batches of half of largest − least
  double standard_error = 0.0;  ///< of the slope
  /// Durbin and Watson's ratio of the residuals of the means: near 2 where they are independent, near 0 where they
  /// follow a curve; 2 where there are none.
  double independence = 2.0;
  int batches = 0;
  double duration = 0.0;  ///< between the first and last batch's mean time

  /// Whether the slope differs from 0 at the level of 5 % of `tests` ≥ 1 slopes together: each is tested at
  /// 5 %/tests [Bonferroni].
  bool is_significant(std::size_t tests) const;
  /// |slope|·duration/oscillation: how far the trend stands out; 0 where both vanish.
  double significance() const;
  /// Whether batches are long against the motion, which the interval of the slope takes for granted: values
  /// oscillate inside each by more than the trend alone moves them, and the residuals of the means are
  /// independent of each other [Durbin, Watson 1951; lower bound at 5 % for 20 means].
  bool has_long_batches() const;
};

/// Fits the trend to the means of at most `batches` batches of neighbouring bins, each long against the
/// oscillation: values that follow each other depend on each other, means of batches hardly do, so that the
/// interval means something.
Drift fit_drift(const BinnedSeries& series, std::uint64_t batches = 20);

}  // namespace fw::analysis
