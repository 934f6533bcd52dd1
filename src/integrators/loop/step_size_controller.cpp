#include "integrators/loop/step_size_controller.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "integrators/loop/particle_norm.hpp"

namespace fw::integrators {

ErrorNorm norm_on(ErrorNorm norm, const OdeSystem& system) {
  return norm == ErrorNorm::largest_particle && !has_particles(system) ? ErrorNorm::root_mean_square : norm;
}

namespace {

template <class Scaled>
double norm_of(ErrorNorm norm, const Scaled& scaled) {
  if (norm == ErrorNorm::largest_particle) {
    return largest_particle_norm(scaled.size(), [&](Index i) { return scaled(i); });
  }
  const double square = scaled.square().sum();
  if (norm == ErrorNorm::root_mean_square) return std::sqrt(square / static_cast<double>(scaled.size()));
  // Eigen's maximum may pass over NaN, the sum of squares does not.
  return std::isfinite(square) ? scaled.abs().maxCoeff() : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

double error_in_tolerances(ErrorNorm norm, const AdaptiveStep& tolerances, ConstVectorRef error,
                           ConstVectorRef y, ConstVectorRef y_new) {
  // One pass without temporaries: this runs once per step over the whole state.
  const auto relative = tolerances.relative_tolerance * y.array().abs().max(y_new.array().abs());
  if (tolerances.absolute_velocity_tolerance == 0.0) {
    return norm_of(norm, error.array() / (tolerances.absolute_tolerance + relative));
  }
  const Index half = error.size() / 2;
  const auto absolute = Eigen::ArrayXd::NullaryExpr(error.size(), [&](Index i) {
    return i < half ? tolerances.absolute_tolerance : tolerances.absolute_velocity_tolerance;
  });
  return norm_of(norm, error.array() / (absolute + relative));
}

namespace {

/// β₁, β₂, β₃ of `ControllerKind`.
struct Gains {
  double now, previous, before_previous;
};

Gains gains(ControllerKind kind) {
  switch (kind) {
    case ControllerKind::proportional_integral:
      return {0.7, -0.4, 0.0};
    case ControllerKind::proportional_integral_derivative:
      return {0.25, 0.5, 0.25};
    case ControllerKind::integral:
      break;
  }
  return {1.0, 0.0, 0.0};
}

}  // namespace

StepSizeController::StepSizeController(const ControllerOptions& options, int estimate_order)
    : options_(options), exponent_(1.0 / estimate_order) {}

double StepSizeController::after_acceptance(double error) {
  // An error of zero (or one that rounding has eaten) must not blow the memory up.
  const double bounded = std::max(error, 1e-10);
  const Gains beta = gains(options_.kind);
  double factor = options_.safety * std::pow(bounded, -beta.now * exponent_) *
                  std::pow(previous_, -beta.previous * exponent_) *
                  std::pow(before_previous_, -beta.before_previous * exponent_);
  factor = std::clamp(factor, options_.smallest_factor, options_.largest_factor);
  if (rejected_) factor = std::min(factor, 1.0);
  rejected_ = false;
  before_previous_ = previous_;
  previous_ = bounded;
  return factor;
}

double StepSizeController::after_rejection(double error) {
  rejected_ = true;
  if (!std::isfinite(error)) return options_.smallest_factor;
  return std::clamp(options_.safety * std::pow(error, -exponent_), options_.smallest_factor, options_.safety);
}

void StepSizeController::restart() {
  previous_ = before_previous_ = 1.0;
  rejected_ = false;
}

void StepSizeController::serialise(StateArchive& archive) {
  archive.visit("last error", previous_);
  archive.visit("last error but one", before_previous_);
  archive.visit("step was rejected", rejected_);
}

}  // namespace fw::integrators
