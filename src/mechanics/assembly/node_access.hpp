#pragma once

#include <array>
#include <cstddef>
#include <utility>

#include "core/vec3.hpp"

namespace fw::mechanics {

/// The vectors of an element's nodes out of an array of xyz after xyz. (Written out node by node: what goes
/// through a loop over an array stays in memory.)
template <class Scalar, std::size_t N>
std::array<Vec3<Scalar>, N> gather(const Scalar* values, const std::array<int, N>& nodes) {
  return [&]<std::size_t... A>(std::index_sequence<A...>) {
    return std::array<Vec3<Scalar>, N>{load3(values, nodes[A])...};
  }
  (std::make_index_sequence<N>{});
}

/// Adds the vectors of an element's nodes to an array of xyz after xyz.
template <class Scalar, std::size_t N>
void scatter_add(Scalar* values, const std::array<int, N>& nodes, const std::array<Vec3<Scalar>, N>& added) {
  [&]<std::size_t... A>(std::index_sequence<A...>) {
    (add3(values, nodes[A], added[A]), ...);
  }
  (std::make_index_sequence<N>{});
}

}  // namespace fw::mechanics
