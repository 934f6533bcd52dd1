#pragma once

#include <cstddef>
#include <cstdint>

#include "mechanics/assembly/node_access.hpp"
#include "ode/second_order_system.hpp"

namespace fw::mechanics {

/// Adds K·dq + D·dv of all elements of a batch at (q, v), with their exact tangents, to `out` [N]; returns
/// how many elements had no direction. Nothing is assembled or allocated.
template <class Batch>
std::uint64_t add_tangent_product(const Batch& batch, const double* q, const double* v, const double* dq,
                                  const double* dv, double* out) {
  std::uint64_t degenerate = 0;
  typename Batch::Tangent tangent;
  const std::size_t size = batch.size();
  for (std::size_t e = 0; e < size; ++e) {
    const auto nodes = batch.nodes(e);
    if (!batch.tangent(e, gather(q, nodes), gather(v, nodes), TangentModel::exact, tangent, degenerate)) {
      continue;
    }
    scatter_add(out, nodes, tangent.product(gather(dq, nodes), gather(dv, nodes)));
  }
  return degenerate;
}

}  // namespace fw::mechanics
