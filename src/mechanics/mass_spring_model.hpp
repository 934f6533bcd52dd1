#pragma once

#include <variant>
#include <vector>

#include "core/types.hpp"
#include "core/vec3.hpp"
#include "mechanics/spring_law.hpp"

namespace fw::mechanics {

/// Springs as a structure of arrays, one entry per spring: four arrays stream through a force kernel without
/// gaps, and a kernel may permute them (slices of four owner vertices) without touching the law.
struct Springs {
  std::vector<int> first;            ///< i
  std::vector<int> second;           ///< j
  std::vector<double> stiffness;     ///< k_s [N/m], or [N] under SpringLaw::strain
  std::vector<double> damping;       ///< k_d [N·s/m]
  std::vector<double> rest_length;   ///< l₀ [m]
  SpringLaw law = SpringLaw::hooke;  ///< one law for all, so that kernels do not branch per spring

  std::size_t size() const { return first.size(); }
};

/// Ties a point to its rest position: force −k (x − x₀) − c v [Zachmann 2011, S37].
struct Anchor {
  int particle = 0;
  Vec3<double> rest_position;  ///< x₀ [m]
  double stiffness = 0.0;      ///< k [N/m]
  double damping = 0.0;        ///< c [N·s/m]
};

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

/// The parameters of a mass-spring system [Zachmann 2011, S5-S9, S37]; the state is kept apart.
struct MassSpringModel {
  std::vector<double> mass;  ///< one per particle, > 0 [kg]
  std::vector<int> fixed;    ///< particles that never move
  Springs springs;
  Vec3<double> gravity{};  ///< [m/s²]
  double drag = 0.0;       ///< force −drag·v on every particle [kg/s]
  std::vector<Anchor> anchors;
  std::vector<Obstacle> obstacles;
};

}  // namespace fw::mechanics
