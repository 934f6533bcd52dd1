#include "study/measure/error_meter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace fw::study {

namespace {

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
  floor_ = std::max(rounding_floor, reference_error() / smallest_scale(*ivp_, scale_) / reference_margin);
}

StateError ErrorMeter::measure(ConstVectorRef state) const {
  return measure_error(*ivp_, state, reference_->states.front(), scale_);
}

double ErrorMeter::floor_at(double scale) const {
  return std::max(rounding_floor * scale, reference_error() / reference_margin);
}

double ErrorMeter::reference_error() const {
  return reference_->states.empty() ? std::numeric_limits<double>::quiet_NaN()
                                    : reference_->states.front().largest_error();
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
