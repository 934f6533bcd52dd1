#pragma once

#include <limits>

#include "mechanics/elements/obstacle_force.hpp"
#include "mechanics/elements/path_piece.hpp"

namespace fw::mechanics {

/// The faces of a box in the order of `contact`: −x, +x, −y, +y, −z, +z.
inline constexpr int box_faces = 6;

/// Depth of x below a face [m].
template <class Scalar>
Scalar depth_below(const Box& box, int face, const Vec3<Scalar>& x) {
  switch (face) {
    case 0:
      return x.x - box.lower.x;
    case 1:
      return box.upper.x - x.x;
    case 2:
      return x.y - box.lower.y;
    case 3:
      return box.upper.y - x.y;
    case 4:
      return x.z - box.lower.z;
    default:
      return box.upper.z - x.z;
  }
}

/// The outward component of v at a face.
template <class Scalar>
Scalar leaving_speed(int face, const Vec3<Scalar>& v) {
  const Scalar& component = face < 2 ? v.x : face < 4 ? v.y : v.z;
  return face % 2 == 0 ? Scalar(-component) : component;
}

/// Which of a solid's faces a point inside is nearest to; planes and balls have one.
template <class Shape, class Scalar>
int nearest_face(const Shape&, const Contact<Scalar>&) {
  return 0;
}
template <class Scalar>
int nearest_face(const Box&, const Contact<Scalar>& at) {
  const auto& n = at.normal;
  if (n.x != 0) return n.x < 0 ? 0 : 1;
  if (n.y != 0) return n.y < 0 ? 2 : 3;
  return n.z < 0 ? 4 : 5;
}

/// 0 where the obstacle does not press, otherwise 1 + the number of the face that does.
template <class Shape, class Scalar>
int obstacle_phase(const Obstacle& obstacle, const Shape& shape, const Vec3<Scalar>& x, const Vec3<Scalar>& v) {
  const Contact<Scalar> at = contact(shape, x);
  if (!(at.depth > 0) || !(unclamped_penalty(obstacle, at, v) > 0)) return 0;
  return 1 + nearest_face(shape, at);
}

/// The sizes of the numbers that depths are differences of [m].
inline double coordinate_size(const Plane& plane) { return size_of(plane.point); }
inline double coordinate_size(const Sphere& sphere) { return size_of(sphere.centre) + sphere.radius; }
inline double coordinate_size(const Box& box) { return std::max(size_of(box.lower), size_of(box.upper)); }

/// What rounding leaves of a depth along a path [m].
template <class Shape, class Scalar>
Scalar depth_rounding(const Shape& shape, const PointPath<Scalar>& path) {
  const Scalar size = std::max({size_of(path.x[0]), size_of(path.x[3]), Scalar(coordinate_size(shape))});
  return 8 * std::numeric_limits<Scalar>::epsilon() * size;
}

/// The smallest and the largest of some numbers.
template <class Scalar>
struct Range {
  Scalar low{}, high{};
};
template <class Points, class Function>
auto range_of(const Points& points, Function f) {
  auto first = f(points[0]);
  Range<decltype(first)> range{first, first};
  for (std::size_t k = 1; k < points.size(); ++k) {
    const auto value = f(points[k]);
    range.low = std::min(range.low, value);
    range.high = std::max(range.high, value);
  }
  return range;
}

/// Whether a flat face with depth in `depth` and leaving speed in `leaving` keeps pressing, or not pressing.
template <class Scalar>
bool face_stays(const Obstacle& obstacle, bool presses, const Range<Scalar>& depth, const Range<Scalar>& leaving,
                const Scalar& rounding) {
  const Scalar k = obstacle.stiffness, c = obstacle.damping;
  if (presses) return depth.low > -rounding && (c == 0 || k * depth.low - c * leaving.high > 0);
  return depth.high <= rounding || k * depth.high - c * leaving.low <= 0;
}

/// Whether the obstacle is in `phase` all along the path; false where that cannot be told.
template <class Scalar>
bool obstacle_stays(const Obstacle& obstacle, const Plane& plane, int phase, const PointPath<Scalar>& path) {
  const auto depth = range_of(path.x, [&](const auto& x) { return contact(plane, x).depth; });
  const Vec3<Scalar> normal = contact(plane, path.x[0]).normal;
  const auto leaving = range_of(path.v, [&](const auto& v) { return dot(v, normal); });
  return face_stays(obstacle, phase != 0, depth, leaving, depth_rounding(plane, path));
}

template <class Scalar>
bool obstacle_stays(const Obstacle& obstacle, const Box& box, int phase, const PointPath<Scalar>& path) {
  const Scalar rounding = depth_rounding(box, path);
  const auto depth = [&](int face) {
    return range_of(path.x, [&](const auto& x) { return depth_below(box, face, x); });
  };
  const auto leaving = [&](int face) {
    return range_of(path.v, [&](const auto& v) { return leaving_speed(face, v); });
  };
  if (phase == 0) {
    bool is_clamped = obstacle.damping > 0.0;
    for (int face = 0; face < box_faces; ++face) {
      const auto range = depth(face);
      if (range.high <= rounding) return true;
      is_clamped = is_clamped && face_stays(obstacle, false, range, leaving(face), rounding);
    }
    return is_clamped;
  }
  const int pressing = phase - 1;
  for (int face = 0; face < box_faces; ++face) {
    if (face == pressing) continue;
    const auto ahead = range_of(
        path.x, [&](const auto& x) { return Scalar(depth_below(box, face, x) - depth_below(box, pressing, x)); });
    if (!(ahead.low >= -rounding)) return false;
  }
  return face_stays(obstacle, true, depth(pressing), leaving(pressing), rounding);
}

template <class Scalar>
bool obstacle_stays(const Obstacle& obstacle, const Sphere& sphere, int phase, const PointPath<Scalar>& path) {
  const Vec3<Scalar> centre{Scalar(sphere.centre.x), Scalar(sphere.centre.y), Scalar(sphere.centre.z)};
  const Scalar k = obstacle.stiffness, c = obstacle.damping, radius = sphere.radius;
  const Scalar rounding = depth_rounding(sphere, path);
  const auto distance = range_of(path.x, [&](const auto& x) { return norm(x - centre); });
  const Scalar speed = range_of(path.v, [](const auto& v) { return norm(v); }).high;
  if (phase != 0) {
    return distance.high < radius + rounding && (c == 0 || k * (radius - distance.high) - c * speed > 0);
  }
  const Vec3<Scalar> towards = midpoint(path.x[0], path.x[3]) - centre;
  const Scalar length = norm(towards);
  if (!(length > 0)) return false;
  const Vec3<Scalar> outwards = (Scalar(1) / length) * towards;
  const Scalar nearest = range_of(path.x, [&](const auto& x) { return dot(x - centre, outwards); }).low;
  if (nearest >= radius - rounding) return true;
  if (c == 0 || !(nearest > 0)) return false;
  // Clamped: the normal turns by no more than the width of the hull over the distance.
  const Scalar width = range_of(path.x, [&](const auto& x) { return norm(x - path.x[0]); }).high;
  const Scalar leaving = range_of(path.v, [&](const auto& v) { return dot(v, outwards); }).low;
  return k * (radius - nearest) - c * (leaving - speed * (2 * width / nearest)) <= 0;
}

/// How much room a solid leaves to a particle that crosses it [m].
inline double solid_thickness(const Plane&) { return std::numeric_limits<double>::infinity(); }
inline double solid_thickness(const Sphere& sphere) { return 2.0 * sphere.radius; }
inline double solid_thickness(const Box& box) {
  return std::min({box.upper.x - box.lower.x, box.upper.y - box.lower.y, box.upper.z - box.lower.z});
}

/// What switches at x: the damper's force where the obstacle begins or ends to press there, twice the pressure
/// where another face takes over. `speed` and `acceleration` bound those over the step.
template <class Shape>
Kink obstacle_kink(const Obstacle& obstacle, const Shape& shape, int from, int to, const Vec3<double>& x,
                   const Vec3<double>& v, double speed, double acceleration) {
  const Contact<double> at = contact(shape, x);
  Kink kink{.rate = obstacle.stiffness * speed + obstacle.damping * acceleration,
            .stiffness = to != 0 ? obstacle.stiffness : 0.0,
            .thickness = solid_thickness(shape)};
  if (from != 0 && to != 0) {
    kink.jump = 2.0 * std::abs(unclamped_penalty(obstacle, at, v));
    kink.rate *= 2.0;
  } else {
    kink.jump = std::abs(unclamped_penalty(obstacle, at, v));
  }
  return kink;
}

}  // namespace fw::mechanics
