#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "core/extended_precision.hpp"
#include "core/vec3.hpp"

namespace fw::mechanics {

/// The path of a point over a time: a cubic in Bernstein form for positions, a quadratic for velocities. A
/// polynomial lies in the convex hull of its control points [Farin 2002, 4.3], which turns tests of points
/// into tests of paths.
template <class Scalar>
struct PointPath {
  std::array<Vec3<Scalar>, 4> x;  ///< control points [m]; the first and the last are the ends
  std::array<Vec3<Scalar>, 3> v;  ///< [m/s]
};

template <class Scalar>
Vec3<Scalar> midpoint(const Vec3<Scalar>& a, const Vec3<Scalar>& b) {
  return Scalar(0.5) * (a + b);
}

/// The largest |component|.
template <class Scalar>
Scalar size_of(const Vec3<Scalar>& a) {
  using std::abs;
  return std::max({Scalar(abs(a.x)), Scalar(abs(a.y)), Scalar(abs(a.z))});
}

/// The Hermite cubic between (x0, v0) and (x1, v1), h apart. Velocities are its derivative, or linear where
/// the difference of the positions is mostly rounding.
template <class Scalar>
PointPath<Scalar> hermite_path(const Vec3<Scalar>& x0, const Vec3<Scalar>& v0, const Vec3<Scalar>& x1,
                               const Vec3<Scalar>& v1, const Scalar& h) {
  const Scalar third = h / 3;
  PointPath<Scalar> path{{x0, x0 + third * v0, x1 - third * v1, x1}, {v0, midpoint(v0, v1), v1}};
  const Scalar rounding = std::numeric_limits<Scalar>::epsilon() * std::max(size_of(x0), size_of(x1));
  const Vec3<Scalar> moved = x1 - x0;
  if (size_of(moved) > Scalar(1e6) * rounding) {
    // The derivative's middle control point, (x_2 − x_1)·3/h.
    path.v[1] = (Scalar(3) / h) * moved - v0 - v1;
  }
  return path;
}

/// Both halves, by de Casteljau's subdivision.
template <class Scalar>
std::array<PointPath<Scalar>, 2> halves(const PointPath<Scalar>& path) {
  const auto& x = path.x;
  const Vec3<Scalar> a = midpoint(x[0], x[1]), b = midpoint(x[1], x[2]), c = midpoint(x[2], x[3]);
  const Vec3<Scalar> ab = midpoint(a, b), bc = midpoint(b, c), middle = midpoint(ab, bc);
  const Vec3<Scalar> u = midpoint(path.v[0], path.v[1]), w = midpoint(path.v[1], path.v[2]);
  const Vec3<Scalar> speed = midpoint(u, w);
  return {{{{x[0], a, ab, middle}, {path.v[0], u, speed}}, {{middle, bc, c, x[3]}, {speed, w, path.v[2]}}}};
}

/// The paths of an element's nodes.
template <class Scalar, std::size_t N>
using NodePaths = std::array<PointPath<Scalar>, N>;

/// What the force of an element jumps by where it switches.
struct Kink {
  double jump = 0.0;       ///< bound on the jump of the force [N]
  double rate = 0.0;       ///< bound on the jump of its time derivative [N/s]
  double stiffness = 0.0;  ///< of the formula after the switch [N/m]; 0: none
  double thickness = 0.0;  ///< of a solid [m]; 0: none
};

}  // namespace fw::mechanics
