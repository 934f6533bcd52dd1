#pragma once

#include <cstddef>
#include <cstdint>

#include "mechanics/assembly/node_access.hpp"

namespace fw::mechanics {

/// Adds the energies of all elements of a batch at q to `sum` [J], one after the other.
template <class Batch, class Scalar>
void add_energy(const Batch& batch, const Scalar* q, Scalar& sum) {
  const std::size_t size = batch.size();
  for (std::size_t e = 0; e < size; ++e) sum += batch.energy(e, gather(q, batch.nodes(e)));
}

/// A batch that knows the power of all its elements from the velocities alone.
template <class Batch>
concept HasTotalPower = requires(const Batch& batch, const double* v) {
  batch.total_dissipated_power(v);
};

/// Adds the power that the elements of a batch take out of the system at (q, v) to `sum` [W]; returns how
/// many elements had no direction.
template <class Batch>
std::uint64_t add_dissipated_power(const Batch& batch, const double* q, const double* v, double& sum) {
  std::uint64_t degenerate = 0;
  if constexpr (HasTotalPower<Batch>) {
    sum += batch.total_dissipated_power(v);
  } else {
    const std::size_t size = batch.size();
    for (std::size_t e = 0; e < size; ++e) {
      const auto nodes = batch.nodes(e);
      sum += batch.dissipated_power(e, gather(q, nodes), gather(v, nodes), degenerate);
    }
  }
  return degenerate;
}

}  // namespace fw::mechanics
