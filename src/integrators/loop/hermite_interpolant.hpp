#pragma once

#include "core/work.hpp"
#include "ode/ivp.hpp"

namespace fw::integrators {

/// The cubic polynomial that has the values y_n, y_{n+1} and the slopes f(t_n, y_n), f(t_{n+1}, y_{n+1}) at
/// both ends of a step. Its error inside is O(h⁴) beside that of the ends [Hairer, Nørsett, Wanner 1993,
/// II.6].
class HermiteInterpolant {
 public:
  HermiteInterpolant(const OdeSystem& system, Work& work) : system_(system), work_(work) {}

  /// The step from (t, start) to (t_next, end). Both states have to stay where they are until the next call.
  void set_step(double t, double t_next, ConstVectorRef start, ConstVectorRef end);

  /// The polynomial at time t. The slopes are evaluated at the first call for a step, which `Work` counts.
  void operator()(double t, VectorRef out);

 private:
  const OdeSystem& system_;
  Work& work_;
  double start_time_ = 0.0, end_time_ = 0.0;
  const double* start_ = nullptr;
  const double* end_ = nullptr;
  bool has_slopes_ = false;
  Vector start_slope_, end_slope_;
};

}  // namespace fw::integrators
