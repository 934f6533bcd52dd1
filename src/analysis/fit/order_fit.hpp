#pragma once

#include <span>
#include <string>
#include <vector>

namespace fw::analysis {

/// The observed order of accuracy: the slope p of log e = log C + p log h by least squares.
struct OrderFit {
  bool valid = false;  ///< enough points in the asymptotic range
  std::string reason;  ///< why not valid
  double order = 0.0;  ///< p
  double order_low =
      0.0;  ///< 95 % confidence interval of p, Student's t with (points − 2) degrees of freedom
  double order_high = 0.0;
  double correlation = 0.0;  ///< Pearson's r of log h and log e
  std::vector<char> used;    ///< one flag per point: entered the fit
  int points = 0;            ///< number of points that entered
};

/// The fewest points that a fit accepts.
inline constexpr int minimum_fit_points = 5;

/// Fits the order to errors e_k > 0 at strictly decreasing steps h_k > 0.
///
/// Which points enter is decided by the data alone, never by the order that is expected:
///  1. a point whose error is not finite, zero, or at most `floor` (rounding, reference) is out;
///  2. from the coarse side on, everything after the first point whose error did not fall is out (noise), and
///  so are the
///     finest points while their local slope is below 1/2 (a floor that nobody told of);
///  3. with the local slopes s_k = log(e_k/e_{k+1})/log(h_k/h_{k+1}) and s* the median of the three finest,
///  the
///     finest point is dropped (and s* taken anew) while its slope differs from s* by more than
///     `slope_tolerance`, and the range is extended to coarser points while it does not (pre-asymptotic
///     range).
OrderFit fit_order(std::span<const double> steps, std::span<const double> errors, double floor,
                   double slope_tolerance = 0.1);

/// The same on the finest run of points whose errors fall without a break down to the floor. For errors that
/// may rise and fall on coarse steps, where the signs of their terms change, but carry no noise above
/// `floor`.
OrderFit fit_finest_order(std::span<const double> steps, std::span<const double> errors, double floor,
                          double slope_tolerance = 0.1);

}  // namespace fw::analysis
