#pragma once

#include <cstdint>

namespace fw::mechanics {

/// The forces of all elements in double precision, as fast as a machine can. The plain loop over the elements
/// is one of them, and the oracle of every other.
class ForceKernel {
 public:
  virtual ~ForceKernel() = default;

  /// Writes f(q, v) [N], xyz after xyz, zero on fixed particles; `f` may alias neither. Returns how many
  /// elements had no direction. Allocates nothing; several threads may call it at once.
  virtual std::uint64_t force(const double* q, const double* v, double* f) const = 0;
};

}  // namespace fw::mechanics
