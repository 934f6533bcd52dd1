#pragma once

#include "problems/problem_entry.hpp"

namespace fw::problems {

/// The stiff Fermi–Pasta–Ulam chain: 2m unit masses between fixed ends, joined alternately by stiff linear
/// and soft quartic springs; parameters `stiff_springs` (m) and `frequency` (ω).
Problem fermi_pasta_ulam(const ProblemParameters& given = {});
ProblemEntry fermi_pasta_ulam_entry();

/// The energies I_j = ½(ẋ_j² + ω² x_j²) of the stiff springs, with x_j = (q_{2j} − q_{2j−1})/√2 the expansion
/// of the j-th one. Their sum is an adiabatic invariant. `y` = (q, v), 2m entries each.
template <class S>
std::vector<S> oscillatory_energies(std::span<const S> y, const S& frequency) {
  const std::size_t n = y.size() / 2;
  std::vector<S> energies(n / 2);
  for (std::size_t j = 0; j < n / 2; ++j) {
    const S expansion = y[2 * j + 1] - y[2 * j];
    const S rate = y[n + 2 * j + 1] - y[n + 2 * j];
    energies[j] = (rate * rate + frequency * frequency * expansion * expansion) / S(4);
  }
  return energies;
}

}  // namespace fw::problems
