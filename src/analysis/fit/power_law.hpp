#pragma once

#include <span>
#include <string>

namespace fw::analysis {

/// y = C x^p fitted by least squares of log y on log x.
struct PowerLaw {
  bool valid = false;         ///< at least three usable points
  std::string reason{};       ///< why not valid
  double exponent = 0.0;      ///< p
  double exponent_low = 0.0;  ///< 95 % interval, Student's t with (points − 2) degrees of freedom
  double exponent_high = 0.0;
  double factor = 0.0;       ///< C
  double correlation = 0.0;  ///< Pearson's r of the logarithms
  int points = 0;

  double operator()(double x) const;
};

/// Fits all points with finite positive x and y. What belongs into the fit is the caller's to decide.
PowerLaw fit_power_law(std::span<const double> x, std::span<const double> y);

/// An interval of an exponent that reaches further than this from the expected one supports nothing.
inline constexpr double decisive_distance = 0.3;

/// What a fitted exponent says of one that theory gives.
enum class LawJudgement { supported, refuted, open };

/// supported: the exponent is within `tolerance` of the expected one or its interval contains that, and the
/// interval reaches no further than `decisive_distance` from it; refuted: neither within the tolerance nor contained; open: the
/// interval is too wide to tell. `law` is valid.
LawJudgement judge_exponent(const PowerLaw& law, double expected, double tolerance);

/// Where two curves through the points (x_k, a_k) and (x_k, b_k) cross, on logarithmic axes.
struct Crossing {
  bool valid = false;    ///< the sign of log a − log b changes exactly once
  std::string reason{};  ///< why not valid
  double x = 0.0;        ///< by linear interpolation of log a − log b over log x
  double low = 0.0;      ///< where the curves cross if one is shifted by the spread of both
  double high = 0.0;
};

/// The crossing of two curves of positive values at increasing x, where point k is only known within the
/// factors `spread_a[k]`, `spread_b[k]` ≥ 1 up and down (1: exact). The interval is where the curves cross if
/// each is shifted by its spread against the other. Points with values that are not finite are left out.
Crossing find_crossing(std::span<const double> x, std::span<const double> a, std::span<const double> b,
                       std::span<const double> spread_a, std::span<const double> spread_b);

}  // namespace fw::analysis
