#pragma once

#include <algorithm>
#include <span>

#include "core/types.hpp"

namespace fw::integrators {

/// out = base + h Σ_j weight[j] · slope[j] over `count` slopes in one pass through memory: blocks that stay
/// in the first level cache take all terms before the next block begins. The terms are added in their order,
/// zero weights are skipped. `out` may be `base`. Works for double and Float128.
template <class S>
void linear_combination(const S* base, const S& h, const S* weight, const S* const* slope, std::size_t count,
                        S* out, std::size_t size) {
  constexpr std::size_t block = 512;
  for (std::size_t begin = 0; begin < size; begin += block) {
    const std::size_t end = std::min(size, begin + block);
    std::size_t j = 0;
    bool first = true;
    const auto start = [&] { return first ? base : out; };
    for (; j < count; ++j) {
      if (weight[j] == 0) continue;
      // Pairs of terms halve the traffic to the partial sum.
      std::size_t next = j + 1;
      while (next < count && weight[next] == 0) ++next;
      const S* from = start();
      const S w = h * weight[j];
      const S* a = slope[j];
      if (next < count) {
        const S u = h * weight[next];
        const S* b = slope[next];
        for (std::size_t k = begin; k < end; ++k) out[k] = (from[k] + w * a[k]) + u * b[k];
        j = next;
      } else {
        for (std::size_t k = begin; k < end; ++k) out[k] = from[k] + w * a[k];
      }
      first = false;
    }
    if (first && out != base) std::copy(base + begin, base + end, out + begin);
  }
}

}  // namespace fw::integrators
