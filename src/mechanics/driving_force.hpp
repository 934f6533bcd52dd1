#pragma once

#include <vector>

#include "formula/vector_function.hpp"

namespace fw::mechanics {

/// A force that is a function of time alone, the same on each of the particles.
struct DrivingForce {
  std::vector<int> particles;
  formula::VectorFunction force;  ///< [N]
};

/// Anchors whose support moves: x₀(t) = rest_position + displacement(t), and the damper acts on the velocity
/// relative to it, f = −k (x − x₀(t)) − c (v − ẋ₀(t)).
struct SupportMotion {
  std::vector<int> anchors;              ///< indices of the model's anchors
  formula::VectorFunction displacement;  ///< [m]
};

}  // namespace fw::mechanics
