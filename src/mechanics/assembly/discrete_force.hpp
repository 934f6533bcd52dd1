#pragma once

#include <cstddef>
#include <cstdint>

#include "mechanics/assembly/block_fill.hpp"
#include "mechanics/assembly/discrete_step.hpp"
#include "mechanics/assembly/node_access.hpp"
#include "mechanics/elements/tangent_blocks.hpp"

namespace fw::mechanics {

/// A batch with a force of its own over a step; the others have that at the midpoint.
template <class Batch>
concept HasDiscreteForce = requires(const Batch& batch, const std::array<Vec3<double>, Batch::arity>& x) {
  batch.discrete_force(std::size_t{0}, x, x, x);
};

/// Adds the forces of a batch over a step to `f` [N]. Elements without a direction are not counted.
template <class Batch>
void add_discrete_force(const Batch& batch, const DiscreteStep& step, double* f) {
  const std::size_t size = batch.size();
  std::uint64_t degenerate = 0;
  for (std::size_t e = 0; e < size; ++e) {
    const auto nodes = batch.nodes(e);
    const auto mean_v = gather(step.mean_velocity, nodes);
    if constexpr (HasDiscreteForce<Batch>) {
      scatter_add(f, nodes,
                  batch.discrete_force(e, gather(step.start, nodes), gather(step.end, nodes), mean_v).force);
    } else {
      scatter_add(f, nodes, batch.force(e, gather(step.middle, nodes), mean_v, degenerate));
    }
  }
}

/// Adds the weighted derivatives of these forces by the end of the step to the values of a tangent matrix.
template <class Batch>
void fill_discrete_blocks(const Batch& batch, const BlockTarget& target, const DiscreteStep& step,
                          const DiscreteWeights& weights, double* values) {
  const auto add = [&](BlockSlot slot, int, int, int a, int b, const auto& blocks) {
    add_block(values, slot, 1.0, blocks, a, b);
  };
  if constexpr (HasDiscreteForce<Batch>) {
    const std::size_t size = batch.size();
    for (std::size_t e = 0; e < size; ++e) {
      const auto nodes = batch.nodes(e);
      const auto at = batch.discrete_force(e, gather(step.start, nodes), gather(step.end, nodes),
                                           gather(step.mean_velocity, nodes));
      const auto blocks = combine(weights.end, at.position, weights.velocity, at.velocity);
      for_each_block(target, e, nodes,
                     [&](BlockSlot slot, int i, int j, int a, int b) { add(slot, i, j, a, b, blocks); });
    }
  } else {
    fill_blocks(
        batch, nullptr, target, step.middle, step.mean_velocity, TangentModel::exact,
        [&](const auto& tangent) {
          return combine(weights.middle, tangent.position_blocks(), weights.velocity,
                         tangent.velocity_blocks());
        },
        add);
  }
}

}  // namespace fw::mechanics
