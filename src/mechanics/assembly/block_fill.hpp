#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "mechanics/assembly/block_pattern.hpp"
#include "mechanics/assembly/element_choice.hpp"
#include "mechanics/assembly/node_access.hpp"
#include "ode/second_order_system.hpp"

namespace fw::mechanics {

/// Where blocks go: the pattern, which particles are fixed (their rows stay empty), and the number of the
/// batch in the pattern.
struct BlockTarget {
  const BlockPattern& pattern;
  const std::vector<char>& fixed;  ///< one flag per particle
  std::size_t batch = 0;
};

/// Adds `factor` times block (a, b) of an element to the values of a matrix.
template <class Blocks>
void add_block(double* values, BlockSlot slot, double factor, const Blocks& blocks, int a, int b) {
  add_block(values, slot, factor * blocks.sign(a, b), blocks.stored(a, b));
}

/// Calls `write(slot, i, j, a, b)` for each block of element e in a row of a free particle: ∂f_i/∂x_j with i
/// and j its nodes number a and b.
template <std::size_t N, class Write>
void for_each_block(const BlockTarget& target, std::size_t e, const std::array<int, N>& nodes,
                    Write&& write) {
  const auto visit = [&](std::size_t a, std::size_t b) {
    write(target.pattern.slot(target.batch, e, a, b, nodes), nodes[a], nodes[b], static_cast<int>(a),
          static_cast<int>(b));
  };
  const auto visit_row = [&]<std::size_t... B>(std::size_t a, std::index_sequence<B...>) {
    if (target.fixed[static_cast<std::size_t>(nodes[a])] == 0) (visit(a, B), ...);
  };
  [&]<std::size_t... A>(std::index_sequence<A...> all) {
    (visit_row(A, all), ...);
  }
  (std::make_index_sequence<N>{});
}

/// Walks over the tangents of the chosen elements of a batch at (q, v). `select(tangent)` picks what is
/// wanted of one, once per element; `write(slot, i, j, a, b, selected)` adds block (a, b) of it to a matrix.
/// Returns how many elements had no direction. Nothing is allocated. (Flattened: the calls per block would
/// cost a third of the time.)
template <class Batch, class Select, class Write>
[[gnu::flatten]] std::uint64_t fill_blocks(const Batch& batch, const BatchChoice* choice,
                                           const BlockTarget& target, const double* q, const double* v,
                                           TangentModel model, Select select, Write write) {
  std::uint64_t degenerate = 0;
  typename Batch::Tangent tangent;
  for_each_element(batch, choice, [&](std::size_t e) {
    const auto nodes = batch.nodes(e);
    if (!batch.tangent(e, gather(q, nodes), gather(v, nodes), model, tangent, degenerate)) return;
    const auto selected = select(tangent);
    for_each_block(target, e, nodes,
                   [&](BlockSlot slot, int i, int j, int a, int b) { write(slot, i, j, a, b, selected); });
  });
  return degenerate;
}

}  // namespace fw::mechanics
