#include "study/measure/error_meter.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fw::study {

namespace {

/// Rounding of double arithmetic relative to the solution's scale.
constexpr double rounding_floor = 2e-13;
/// A reference has to be this much better than every error that is reported.
constexpr double reference_margin = 0.01;

}  // namespace

ErrorMeter::ErrorMeter(const SharedProblem& problem, const RunContext& context)
    : ivp_(&problem.ivp()), reference_(&problem.reference(context)), status_(reference_->status) {
  if (!status_.ok()) return;
  if (reference_->states.empty()) {
    status_ = {StatusCode::accuracy_not_reached, "there is no reference at the end time"};
    return;
  }
  scale_ = measure_scale(*ivp_, reference_->states.front());
  const double size =
      ivp_->system->second_order() != nullptr ? std::min(scale_.position, scale_.velocity) : scale_.state;
  floor_ = std::max(rounding_floor, reference_->states.front().largest_error() / size / reference_margin);
}

double ErrorMeter::error(ConstVectorRef state) const {
  return measure_error(*ivp_, state, reference_->states.front(), scale_).relative;
}

std::string ErrorMeter::norm() const {
  if (ivp_->system->second_order() == nullptr) {
    return fmt::format("root mean square over the state / {:.6g}, at the end time", scale_.state);
  }
  return fmt::format(
      "sqrt(((rms position error / {:.6g} m)^2 + (rms velocity error / {:.6g} m/s)^2) / 2), at the end time",
      scale_.position, scale_.velocity);
}

}  // namespace fw::study
