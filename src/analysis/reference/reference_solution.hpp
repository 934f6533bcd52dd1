#pragma once

#include <span>
#include <vector>

#include "analysis/reference/gragg_extrapolation.hpp"
#include "core/status.hpp"
#include "core/work.hpp"
#include "problems/problem.hpp"

namespace fw::analysis {

/// A state known to many digits, and how many.
struct ReferenceState {
  double time = 0.0;            ///< [s]
  std::vector<Float128> value;  ///< y(t)
  /// A bound on |value − y(t)| per component: the measured difference of two resolutions, or the rounding of
  /// a closed form.
  std::vector<Float128> error;

  /// `value` rounded to double.
  Vector rounded() const;
  /// max_i error[i].
  double largest_error() const;
};

/// Where the digits come from.
enum class ReferenceSource { exact, certified };

/// Reference states at the times asked for.
struct ReferenceSolution {
  std::vector<ReferenceState> states;  ///< one per time; fewer where the status is a failure
  ReferenceSource source = ReferenceSource::certified;
  Status status;        ///< success: every state has the accuracy asked for
  Work work;            ///< of both resolutions together
  bool cached = false;  ///< read from a ReferenceCache
};

/// The two resolutions of a certified reference and what is asked of them. They differ in tolerance, order
/// and hence in every step taken, so that a mistake which depends on any of these shows in their difference.
struct ReferenceOptions {
  ExtrapolationSettings fine{harmonic_extrapolation(10), 1e-32, 71, 2, 5'000'000, 1'000};
  ExtrapolationSettings coarse{harmonic_extrapolation(8), 1e-28, 50, 1, 5'000'000, 1'000};
  /// The error bound has to stay below accuracy · (largest |y_i| met, but at least 1e-9 of the largest
  /// component's); otherwise the status is accuracy_not_reached.
  double accuracy = 1e-19;
  /// Told after each step of either resolution: the part of the whole work that is done, in [0, 1], with the
  /// coarse resolution as `coarse_share` of it. The digits do not depend on it. It may throw to end the work.
  ExtrapolationProgress progress{};

  static constexpr double coarse_share = 0.45;
};

/// y at each of `times` (non-decreasing, ≥ t₀; `ivp.t1` is not looked at), integrated twice in binary128; the
/// value is the finer one's, the error the difference. Throws InputError for times or sizes that make no
/// sense; numerical failure is told by the status.
ReferenceSolution certified_reference(const Ivp& ivp, std::span<const double> times,
                                      const ReferenceOptions& options = {});
ReferenceSolution certified_reference(const Ivp& ivp, double time, const ReferenceOptions& options = {});

/// The closed form where `problem` has one, with the error 64 ε (‖y‖ + |t| ‖f(t, y)‖) of evaluating it in
/// binary128 (maximum norms); otherwise the certified reference.
ReferenceSolution reference(const Problem& problem, std::span<const double> times,
                            const ReferenceOptions& options = {});
ReferenceSolution reference(const Problem& problem, double time, const ReferenceOptions& options = {});

}  // namespace fw::analysis
