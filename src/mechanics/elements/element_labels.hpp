#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "core/vec3.hpp"

namespace fw::mechanics {

/// How schemes that treat some forces implicitly and the others explicitly see an element.
enum class ElementRole {
  elastic,   ///< stores energy in its shape: springs, anchors
  external,  ///< acts from outside: gravity, drag, obstacles
};

/// What an element of a type is, the same for all batches of the type.
struct ElementLabels {
  std::string_view kind;  ///< for messages, in the plural: "springs"
  ElementRole role = ElementRole::elastic;
  std::string_view energy;  ///< the name of the energy it adds to, see `Energies`; "elastic" and so on
};

/// One vector per node of an element: places [m], velocities [m/s], forces [N].
template <class Scalar, int Nodes>
using NodeVectors = std::array<Vec3<Scalar>, static_cast<std::size_t>(Nodes)>;

}  // namespace fw::mechanics
