#pragma once

#include <string>

#include "core/status.hpp"
#include "oracles/sundials/callback_guard.hpp"

namespace fw::oracles::detail {

/// What a run with ARKODE or IDA tells of itself while it is inside the library.
struct RunReport {
  CallbackGuard guard;
  std::string message;          ///< the library's last error or warning in the step
  bool met_non_finite = false;  ///< a function of ours was not finite since time last advanced
};

/// A SUNDIALS error handler: keeps the message in the RunReport in place of printing it.
void keep_message(int error_code, const char* module, const char* function, char* text,
                  void* report) noexcept;

/// What the flag of a failed step means for people: "ARKODE at t = 0.5: ARK_CONV_FAILURE: <message>".
/// `flag_name` was allocated by the library and is freed.
Status describe_failure(StatusCode code, const char* library, double t, char* flag_name,
                        const RunReport& report);

/// ARKODE and IDA only warn of steps below the rounding of t and would go on with them for ever, as they do
/// before a time from which on the right-hand side is no number: says so after some such steps.
class StallCheck {
 public:
  explicit StallCheck(double start) : reached_(start) {}

  /// To be called after each good step that ended at `t`.
  Status operator()(const char* library, double t, RunReport& report);

 private:
  double reached_;
  int steps_without_progress_ = 0;
};

/// What went wrong in ARKODE (ARKStep and MRIStep share their flags); `last_linear_flag` is what the linear
/// solver returned last.
StatusCode code_of_arkode_flag(int flag, long last_linear_flag, const RunReport& report);
/// The same for IDA.
StatusCode code_of_ida_flag(int flag, long last_linear_flag, const RunReport& report);

}  // namespace fw::oracles::detail
