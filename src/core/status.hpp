#pragma once

#include <string>
#include <string_view>

namespace fw {

/// How a run or a solve ended. A failure is data of a study, not an exception.
enum class StatusCode {
  success,
  stopped_by_observer,   ///< an observer asked to stop; what was computed is valid
  interrupted,           ///< the user asked to stop (SIGINT, SIGTERM)
  step_limit,            ///< more steps needed than allowed
  step_too_small,        ///< the error test or a solver forces the step below its minimum
  no_progress,           ///< steps far shorter than anything asks for, without an end
  newton_failed,         ///< Newton's iteration did not converge
  linear_solver_failed,  ///< the true residual stayed above the tolerance
  matrix_singular,       ///< a factorisation met a zero pivot
  matrix_indefinite,     ///< conjugate gradients or Cholesky met pᵀAp ≤ 0
  non_finite,            ///< the state became NaN or infinite
  blow_up,               ///< the state grew beyond every physical size
  accuracy_not_reached,  ///< the run ended, but its measured error is above what was asked for
  library_failure,       ///< a foreign solver gave up; the message carries its own reason
};

/// The name of a code as it is written to result files, for example "newton_failed".
std::string_view to_string(StatusCode code);

/// The end of a run: a code, and a sentence for people that says where and why.
struct Status {
  StatusCode code = StatusCode::success;
  std::string message;

  bool ok() const { return code == StatusCode::success; }

  /// "success", or "code: message".
  std::string describe() const;
};

}  // namespace fw
