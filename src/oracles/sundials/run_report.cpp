#include "oracles/sundials/run_report.hpp"

#include <arkode/arkode.h>
#include <fmt/format.h>
#include <ida/ida.h>
#include <sundials/sundials_linearsolver.h>

#include <cstdlib>

namespace fw::oracles::detail {

namespace {

/// KLU met a matrix that it cannot factorise.
bool is_singular(long last_linear_flag) {
  return last_linear_flag == SUNLS_PACKAGE_FAIL_REC || last_linear_flag == SUNLS_PACKAGE_FAIL_UNREC ||
         last_linear_flag == SUNLS_LUFACT_FAIL;
}

StatusCode code_of_failed_solve(long last_linear_flag, const RunReport& report) {
  if (report.met_non_finite) return StatusCode::non_finite;
  return is_singular(last_linear_flag) ? StatusCode::matrix_singular : StatusCode::newton_failed;
}

}  // namespace

void keep_message(int, const char*, const char*, char* text, void* report) noexcept {
  static_cast<RunReport*>(report)->guard.call([&] {
    static_cast<RunReport*>(report)->message = text;
    return 0;
  });
}

Status describe_failure(StatusCode code, const char* library, double t, char* flag_name,
                        const RunReport& report) {
  Status status{code, fmt::format("{} at t = {:.6g}: {}{}{}", library, t, flag_name,
                                  report.message.empty() ? "" : ": ", report.message)};
  std::free(flag_name);
  return status;
}

Status StallCheck::operator()(const char* library, double t, RunReport& report) {
  constexpr int most_steps_without_progress = 10;
  if (t > reached_) {
    reached_ = t;
    steps_without_progress_ = 0;
    report.met_non_finite = false;
    return {};
  }
  if (++steps_without_progress_ < most_steps_without_progress) return {};
  return {report.met_non_finite ? StatusCode::non_finite : StatusCode::step_too_small,
          fmt::format("{} at t = {:.6g}: the step fell below the rounding of t{}{}{}", library, t,
                      report.met_non_finite ? ", before a right-hand side that is not finite" : "",
                      report.message.empty() ? "" : ": ", report.message)};
}

StatusCode code_of_arkode_flag(int flag, long last_linear_flag, const RunReport& report) {
  switch (flag) {
    case ARK_TOO_MUCH_WORK:
      return StatusCode::step_limit;
    case ARK_ERR_FAILURE:
    case ARK_TOO_MUCH_ACC:
      return report.met_non_finite ? StatusCode::non_finite : StatusCode::step_too_small;
    case ARK_CONV_FAILURE:
    case ARK_NLS_SETUP_RECVR:
      return code_of_failed_solve(last_linear_flag, report);
    case ARK_LSETUP_FAIL:
    case ARK_NLS_SETUP_FAIL:
      return report.met_non_finite ? StatusCode::non_finite : StatusCode::matrix_singular;
    case ARK_LSOLVE_FAIL:
      return StatusCode::linear_solver_failed;
    case ARK_RHSFUNC_FAIL:
    case ARK_FIRST_RHSFUNC_ERR:
    case ARK_REPTD_RHSFUNC_ERR:
    case ARK_UNREC_RHSFUNC_ERR:
      return StatusCode::non_finite;
    default:
      return report.met_non_finite ? StatusCode::non_finite : StatusCode::library_failure;
  }
}

StatusCode code_of_ida_flag(int flag, long last_linear_flag, const RunReport& report) {
  switch (flag) {
    case IDA_TOO_MUCH_WORK:
      return StatusCode::step_limit;
    case IDA_ERR_FAIL:
    case IDA_TOO_MUCH_ACC:
      return report.met_non_finite ? StatusCode::non_finite : StatusCode::step_too_small;
    case IDA_CONV_FAIL:
      return code_of_failed_solve(last_linear_flag, report);
    case IDA_LSETUP_FAIL:
      return report.met_non_finite ? StatusCode::non_finite : StatusCode::matrix_singular;
    case IDA_LSOLVE_FAIL:
      return StatusCode::linear_solver_failed;
    case IDA_RES_FAIL:
    case IDA_REP_RES_ERR:
    case IDA_FIRST_RES_FAIL:
      return StatusCode::non_finite;
    default:
      return report.met_non_finite ? StatusCode::non_finite : StatusCode::library_failure;
  }
}

}  // namespace fw::oracles::detail
