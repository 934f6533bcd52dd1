#pragma once

#include <limits>

#include "mechanics/elements/path_piece.hpp"
#include "mechanics/elements/spring_force.hpp"

namespace fw::mechanics {

/// 1 where a rope with d = x_j − x_i is taut, 0 where it is slack.
template <class Scalar>
int rope_phase(const SpringParameters& rope, const Vec3<Scalar>& d) {
  return spring_acts<SpringLaw::tension_only>(rope, norm(d)) ? 1 : 0;
}

/// Whether the rope is taut (`phase` 1) or slack (0) all along the paths of its ends; false where that cannot
/// be told. Seen from one end the other one moves with respect to a ball of radius l₀.
template <class Scalar>
bool rope_stays(const SpringParameters& rope, int phase, const NodePaths<Scalar, 2>& path) {
  if (rope.rest_length == 0.0) return true;  // always taut, and linear
  const Scalar rest_length = rope.rest_length;
  const Scalar size = std::max({size_of(path[0].x[0]), size_of(path[1].x[0]), rest_length});
  const Scalar rounding = 8 * std::numeric_limits<Scalar>::epsilon() * size;
  std::array<Vec3<Scalar>, 4> d;
  for (std::size_t k = 0; k < d.size(); ++k) d[k] = path[1].x[k] - path[0].x[k];
  if (phase == 0) {
    const Scalar limit = (rest_length + rounding) * (rest_length + rounding);
    return std::ranges::all_of(d, [&](const auto& at) { return dot(at, at) <= limit; });
  }
  const Vec3<Scalar> towards = midpoint(d[0], d[3]);
  const Scalar limit = (rest_length - rounding) * norm(towards);
  return limit > 0 && std::ranges::all_of(d, [&](const auto& at) { return dot(at, towards) >= limit; });
}

}  // namespace fw::mechanics
