#pragma once

namespace fw::mechanics {

/// A step of an energy-momentum scheme: places and velocities, xyz after xyz.
struct DiscreteStep {
  const double* start = nullptr;          ///< q [m]
  const double* end = nullptr;            ///< q' [m]
  const double* middle = nullptr;         ///< ½ (q + q')
  const double* mean_velocity = nullptr;  ///< ½ (v + v') [m/s]
};

/// What the derivatives of a discrete force are multiplied by.
struct DiscreteWeights {
  double end = 0.0;       ///< of derivatives by q'
  double middle = 0.0;    ///< of derivatives by the middle
  double velocity = 0.0;  ///< of derivatives by the mean velocity
};

}  // namespace fw::mechanics
