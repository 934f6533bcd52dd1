#pragma once

#include <cstddef>
#include <cstdint>

#include "mechanics/assembly/element_choice.hpp"
#include "mechanics/assembly/node_access.hpp"

namespace fw::mechanics {

/// A batch whose dampers can be told from its elasticity.
template <class Batch>
concept HasDampingForce = requires(const Batch& batch, const std::array<Vec3<double>, Batch::arity>& x) {
  batch.damping_force(std::size_t{0}, x, x);
};

/// Adds the forces of all elements of a batch at (q, v) to `f` [N], all with xyz after xyz; returns how many
/// elements had no direction. The plain loop in the order of the elements: the one force of the project in
/// every arithmetic, and the oracle of any faster kernel. Nothing is allocated.
template <class Batch, class Scalar>
std::uint64_t add_force(const Batch& batch, const Scalar* q, const Scalar* v, Scalar* f) {
  std::uint64_t degenerate = 0;
  const std::size_t size = batch.size();
  for (std::size_t e = 0; e < size; ++e) {
    const auto nodes = batch.nodes(e);
    scatter_add(f, nodes, batch.force(e, gather(q, nodes), gather(v, nodes), degenerate));
  }
  return degenerate;
}

/// The same for a choice of elements, or for their dampers alone. The dampers of a batch that cannot tell
/// them apart are its force at (q, v) without that at (q, 0).
template <class Batch>
std::uint64_t add_force(const Batch& batch, const BatchChoice& choice, const double* q, const double* v,
                        double* f) {
  std::uint64_t degenerate = 0;
  if (choice.part != BatchChoice::Part::dampers) {
    for_each_element(batch, &choice, [&](std::size_t e) {
      const auto nodes = batch.nodes(e);
      scatter_add(f, nodes, batch.force(e, gather(q, nodes), gather(v, nodes), degenerate));
    });
    return degenerate;
  }
  for_each_element(batch, &choice, [&](std::size_t e) {
    const auto nodes = batch.nodes(e);
    const auto x = gather(q, nodes), w = gather(v, nodes);
    if constexpr (HasDampingForce<Batch>) {
      scatter_add(f, nodes, batch.damping_force(e, x, w));
    } else {
      auto force = batch.force(e, x, w, degenerate);
      const auto at_rest = batch.force(e, x, {}, degenerate);
      for (std::size_t a = 0; a < force.size(); ++a) force[a] -= at_rest[a];
      scatter_add(f, nodes, force);
    }
  });
  return degenerate;
}

}  // namespace fw::mechanics
