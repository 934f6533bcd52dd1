#pragma once

#include <string>

#include "study/measure/error_norms.hpp"
#include "study/shared_problem.hpp"

namespace fw::study {

/// Measures relative errors at the end of a problem, and knows how far down they mean something.
class ErrorMeter {
 public:
  /// Gets the reference; `status` says whether there is one.
  ErrorMeter(const SharedProblem& problem, const RunContext& context);

  const Status& status() const { return status_; }

  /// Against the reference's end state, see `measure_error`.
  StateError measure(ConstVectorRef state) const;
  /// Its relative error.
  double error(ConstVectorRef state) const { return measure(state).relative; }

  /// Relative errors below are dominated by rounding (2e-13) or by 100 times the reference's own error bound.
  double floor() const { return floor_; }
  /// Whether it is the reference's own error bound that sets the floor.
  bool is_limited_by_reference() const { return floor_ > rounding_floor; }
  /// The floor of absolute errors in components of size `scale`.
  double floor_at(double scale) const;

  /// What relative errors are related to.
  const StateScale& scale() const { return scale_; }
  /// Bound on the reference's own error, largest component; NaN where there is no reference.
  double reference_error() const;

  /// The norm in words, with its scales.
  std::string norm() const;

  /// The reference's end state in double.
  Vector end_state() const { return reference_->states.front().rounded(); }

 private:
  /// Rounding of double arithmetic relative to the solution's scale.
  static constexpr double rounding_floor = 2e-13;

  const Ivp* ivp_;
  const analysis::ReferenceSolution* reference_;
  Status status_;
  StateScale scale_;
  double floor_ = 0.0;
};

}  // namespace fw::study
