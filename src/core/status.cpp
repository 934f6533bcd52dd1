#include "core/status.hpp"

namespace fw {

std::string_view to_string(StatusCode code) {
  switch (code) {
    case StatusCode::success:
      return "success";
    case StatusCode::stopped_by_observer:
      return "stopped_by_observer";
    case StatusCode::interrupted:
      return "interrupted";
    case StatusCode::step_limit:
      return "step_limit";
    case StatusCode::step_too_small:
      return "step_too_small";
    case StatusCode::no_progress:
      return "no_progress";
    case StatusCode::newton_failed:
      return "newton_failed";
    case StatusCode::linear_solver_failed:
      return "linear_solver_failed";
    case StatusCode::matrix_singular:
      return "matrix_singular";
    case StatusCode::matrix_indefinite:
      return "matrix_indefinite";
    case StatusCode::non_finite:
      return "non_finite";
    case StatusCode::blow_up:
      return "blow_up";
    case StatusCode::accuracy_not_reached:
      return "accuracy_not_reached";
    case StatusCode::library_failure:
      return "library_failure";
  }
  return "unknown";
}

std::string Status::describe() const {
  std::string text(to_string(code));
  if (!message.empty()) text += ": " + message;
  return text;
}

}  // namespace fw
