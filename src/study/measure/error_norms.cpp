#include "study/measure/error_norms.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fw::study {

namespace {

/// A scale that is zero (a system at rest) would divide by zero: errors are then absolute.
double positive_or_one(double scale) {
  return scale > 0.0 ? scale : 1.0;
}

bool is_second_order(const Ivp& ivp) {
  return ivp.system->second_order() != nullptr;
}

}  // namespace

double root_mean_square(ConstVectorRef values) {
  return values.size() == 0 ? 0.0 : values.norm() / std::sqrt(static_cast<double>(values.size()));
}

double smallest_scale(const Ivp& ivp, const StateScale& scale) {
  return is_second_order(ivp) ? std::min(scale.position, scale.velocity) : scale.state;
}

double relative_norm(const Ivp& ivp, ConstVectorRef difference, const StateScale& scale) {
  if (!is_second_order(ivp)) return root_mean_square(difference) / scale.state;
  const Index n = difference.size() / 2;
  return std::sqrt(0.5 * (std::pow(root_mean_square(difference.head(n)) / scale.position, 2) +
                          std::pow(root_mean_square(difference.tail(n)) / scale.velocity, 2)));
}

StateScale measure_scale(const Ivp& ivp, const analysis::ReferenceState& reference) {
  const Vector end = reference.rounded();
  StateScale scale;
  scale.state = positive_or_one(root_mean_square(end));
  if (is_second_order(ivp)) {
    const Index n = end.size() / 2;
    // Where points return close to their start, the change is no measure of the motion.
    const double change = root_mean_square(end.head(n) - ivp.y0.head(n));
    const double size = root_mean_square(end.head(n));
    scale.position = positive_or_one(std::max(change, 1e-3 * size));
    // Velocities that the last digits of positions make are those of a system at rest.
    constexpr double last_digits = 1e4 * std::numeric_limits<double>::epsilon();
    const double speed = std::max(root_mean_square(end.tail(n)), root_mean_square(ivp.y0.tail(n)));
    scale.velocity = positive_or_one(speed * (ivp.t1 - ivp.t0) > last_digits * size ? speed : 0.0);
  }
  return scale;
}

StateError measure_error(const Ivp& ivp, ConstVectorRef state, const analysis::ReferenceState& reference,
                         const StateScale& scale) {
  Vector difference(state.size());
  for (Index i = 0; i < state.size(); ++i) {
    difference[i] = static_cast<double>(Float128(state[i]) - reference.value[static_cast<std::size_t>(i)]);
  }
  StateError error;
  error.components.assign(difference.data(), difference.data() + difference.size());
  error.relative = relative_norm(ivp, difference, scale);
  if (!is_second_order(ivp)) {
    error.position = error.velocity = std::numeric_limits<double>::quiet_NaN();
    return error;
  }
  const Index n = state.size() / 2;
  error.position = root_mean_square(difference.head(n));
  error.velocity = root_mean_square(difference.tail(n));
  return error;
}

}  // namespace fw::study
