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

  /// The relative error of an end state, see `measure_error`.
  double error(ConstVectorRef state) const;

  /// Below, rounding (2e-13) or a hundred times the reference's own error reigns.
  double floor() const { return floor_; }

  /// The norm in words, with its scales.
  std::string norm() const;

  /// The reference's end state in double.
  Vector end_state() const { return reference_->states.front().rounded(); }

 private:
  const Ivp* ivp_;
  const analysis::ReferenceSolution* reference_;
  Status status_;
  StateScale scale_;
  double floor_ = 0.0;
};

}  // namespace fw::study
