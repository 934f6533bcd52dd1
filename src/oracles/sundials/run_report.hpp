#pragma once

#include <string>

#include "core/status.hpp"
#include "oracles/sundials/callback_guard.hpp"

namespace fw::oracles::detail {

/// What a run with ARKODE or IDA tells of itself while it is inside the library.
struct RunReport {
  CallbackGuard guard;
  std::string message;          ///< the library's last error message
  bool met_non_finite = false;  ///< a function of ours was not finite since the last good step
};

/// A SUNDIALS error handler: keeps the message in the RunReport in place of printing it. Warnings pass.
void keep_error_message(int error_code, const char* module, const char* function, char* text,
                        void* report) noexcept;

/// What the flag of a failed step means for people: "ARKODE at t = 0.5: ARK_CONV_FAILURE: <message>".
/// `flag_name` was allocated by the library and is freed.
Status describe_failure(StatusCode code, const char* library, double t, char* flag_name,
                        const RunReport& report);

/// What went wrong in ARKODE (ARKStep and MRIStep share their flags); `last_linear_flag` is what the linear
/// solver returned last.
StatusCode code_of_arkode_flag(int flag, long last_linear_flag, const RunReport& report);
/// The same for IDA.
StatusCode code_of_ida_flag(int flag, long last_linear_flag, const RunReport& report);

}  // namespace fw::oracles::detail
