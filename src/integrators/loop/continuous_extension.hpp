#pragma once

#include "core/types.hpp"

namespace fw::integrators {

/// What a stepper whose scheme has continuous weights b_i(θ) is as well: it gives states inside the step
/// accepted last from the slopes of its stages, with an order one below its own.
class ContinuousExtension {
 public:
  virtual ~ContinuousExtension() = default;

  /// Whether the scheme has such weights.
  virtual bool has_continuous_weights() const = 0;

  /// y(t + θh) = y + h Σ_i b_i(θ) k_i, where y = `start` and h are those of the step accepted last.
  virtual void extend(double theta, double h, ConstVectorRef start, VectorRef out) = 0;
};

}  // namespace fw::integrators
