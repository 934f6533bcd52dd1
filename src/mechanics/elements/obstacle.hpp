#pragma once

#include <variant>

#include "core/vec3.hpp"

namespace fw::mechanics {

/// The half space (x − point)·normal < 0 is solid.
struct Plane {
  Vec3<double> point;   ///< [m]
  Vec3<double> normal;  ///< unit vector out of the solid
};

/// The ball ‖x − centre‖ < radius is solid.
struct Sphere {
  Vec3<double> centre;  ///< [m]
  double radius = 1.0;  ///< [m]
};

/// The axis-aligned box lower < x < upper is solid; a point inside is pushed out through the nearest face.
struct Box {
  Vec3<double> lower;  ///< [m]
  Vec3<double> upper;  ///< [m]
};

/// A solid that pushes points out by a penalty force [Zachmann 2011, S9]. With penetration depth δ > 0 and
/// outward unit normal n: f = max(k δ − c v·n, 0) n. It never pulls.
struct Obstacle {
  std::variant<Plane, Sphere, Box> shape;
  double stiffness = 0.0;  ///< k [N/m]
  double damping = 0.0;    ///< c [N·s/m]
};

}  // namespace fw::mechanics
