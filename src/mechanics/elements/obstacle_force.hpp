#pragma once

#include <array>
#include <cmath>

#include "core/extended_precision.hpp"
#include "core/vec3.hpp"
#include "mechanics/elements/obstacle.hpp"

namespace fw::mechanics {

/// Where a point stands with respect to a solid. Outside (`depth` ≤ 0) only the depth's sign has a meaning.
template <class Scalar>
struct Contact {
  Scalar depth{};         ///< δ [m], > 0 inside
  Vec3<Scalar> normal{};  ///< n, unit vector out of the solid; ∂δ/∂x = −n
  Scalar curvature{};  ///< κ [1/m] of the level set of δ through the point: ∂n/∂x = κ (I − n nᵀ)
};

/// δ = −(x − point)·n.
template <class Scalar>
Contact<Scalar> contact(const Plane& plane, const Vec3<Scalar>& x) {
  const Vec3<Scalar> normal{Scalar(plane.normal.x), Scalar(plane.normal.y), Scalar(plane.normal.z)};
  const Vec3<Scalar> point{Scalar(plane.point.x), Scalar(plane.point.y), Scalar(plane.point.z)};
  return {dot(point - x, normal), normal, Scalar(0)};
}

/// δ = radius − ‖x − centre‖. At the centre, where every direction is equally short, the normal is (0, 0, 1)
/// and the ball acts as the half space below its top.
template <class Scalar>
Contact<Scalar> contact(const Sphere& sphere, const Vec3<Scalar>& x) {
  using std::sqrt;
  const Vec3<Scalar> offset =
      x - Vec3<Scalar>{Scalar(sphere.centre.x), Scalar(sphere.centre.y), Scalar(sphere.centre.z)};
  const Scalar distance_squared = dot(offset, offset);
  if (real_part(distance_squared) == 0) {
    return {sphere.radius - offset.z, {Scalar(0), Scalar(0), Scalar(1)}, Scalar(0)};
  }
  const Scalar distance = sqrt(distance_squared);
  const Scalar curvature = Scalar(1) / distance;
  return {sphere.radius - distance, curvature * offset, curvature};
}

/// δ is the distance to the nearest face. On a ridge (faces equally near) the first of −x, +x, −y, +y, −z, +z
/// is taken; δ is continuous there, n is not.
template <class Scalar>
Contact<Scalar> contact(const Box& box, const Vec3<Scalar>& x) {
  const std::array<Scalar, 6> depth = {x.x - box.lower.x, box.upper.x - x.x, x.y - box.lower.y,
                                       box.upper.y - x.y, x.z - box.lower.z, box.upper.z - x.z};
  std::size_t nearest = 0;
  for (std::size_t face = 1; face < depth.size(); ++face) {
    if (real_part(depth[face]) < real_part(depth[nearest])) nearest = face;
  }
  const Scalar sign(nearest % 2 == 0 ? -1 : 1);
  Contact<Scalar> result{depth[nearest], {}, Scalar(0)};
  (nearest < 2 ? result.normal.x : nearest < 4 ? result.normal.y : result.normal.z) = sign;
  return result;
}

/// The pressing force k δ − c v·n of a point inside the solid before it is clamped to ≥ 0 [N].
template <class Scalar>
Scalar unclamped_penalty(const Obstacle& obstacle, const Contact<Scalar>& at, const Vec3<Scalar>& v) {
  return obstacle.stiffness * at.depth - obstacle.damping * dot(v, at.normal);
}

/// max(k δ − c v·n, 0) n where δ > 0, otherwise zero [N] [Zachmann 2011, S9]. `Shape` is an alternative of
/// `obstacle.shape`, passed separately so that a loop over points branches on it once.
template <class Shape, class Scalar>
Vec3<Scalar> obstacle_force(const Obstacle& obstacle, const Shape& shape, const Vec3<Scalar>& x,
                            const Vec3<Scalar>& v) {
  const Contact<Scalar> at = contact(shape, x);
  if (!(real_part(at.depth) > 0)) return {};
  const Scalar magnitude = unclamped_penalty(obstacle, at, v);
  return real_part(magnitude) > 0 ? magnitude * at.normal : Vec3<Scalar>{};
}

/// ½ k δ² where δ > 0, otherwise zero [J].
template <class Shape, class Scalar>
Scalar obstacle_energy(const Obstacle& obstacle, const Shape& shape, const Vec3<Scalar>& x) {
  const Scalar depth = contact(shape, x).depth;
  return real_part(depth) > 0 ? 0.5 * obstacle.stiffness * depth * depth : Scalar(0);
}

/// The power that a contact takes out of the system, (k δ − ‖f‖) v·n [W]: c (v·n)² while the obstacle
/// presses; k δ (v·n) > 0 while the force is clamped, when the point leaves faster than the solid springs
/// back and the stored energy is lost.
template <class Shape>
double obstacle_dissipated_power(const Obstacle& obstacle, const Shape& shape, const Vec3<double>& x,
                                 const Vec3<double>& v) {
  const Contact<double> at = contact(shape, x);
  if (!(at.depth > 0.0)) return 0.0;
  const double leaving = dot(v, at.normal);
  if (unclamped_penalty(obstacle, at, v) > 0.0) return obstacle.damping * leaving * leaving;
  return obstacle.stiffness * at.depth * leaving;
}

}  // namespace fw::mechanics
