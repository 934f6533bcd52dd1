#include "integrators/tableau/extended_precision_steps.hpp"

#include <algorithm>

namespace fw::integrators {

std::vector<Float128> run_extended_steps(const Ivp& ivp, std::uint64_t steps, const ExtendedStep& step) {
  std::vector<Float128> y = initial_state_extended(ivp);
  const Float128 h = (Float128(ivp.t1) - Float128(ivp.t0)) / steps;
  for (std::uint64_t n = 0; n < steps; ++n) step(Float128(ivp.t0) + n * h, h, y);
  return y;
}

std::vector<Float128> extended_jacobian(const OdeSystem& system, const Float128& t,
                                        const std::vector<Float128>& y) {
  const std::size_t n = y.size();
  const Float128 increment = 1e-11;
  std::vector<Float128> result(n * n), shifted = y, above(n), below(n);
  for (std::size_t j = 0; j < n; ++j) {
    shifted[j] = y[j] + increment;
    system.rhs(t, shifted, above);
    shifted[j] = y[j] - increment;
    system.rhs(t, shifted, below);
    shifted[j] = y[j];
    for (std::size_t i = 0; i < n; ++i) result[i * n + j] = (above[i] - below[i]) / (2 * increment);
  }
  return result;
}

void solve_extended_system(std::vector<Float128>& A, std::vector<Float128>& b) {
  const std::size_t n = b.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i) {
      if (abs(A[i * n + k]) > abs(A[pivot * n + k])) pivot = i;
    }
    if (pivot != k) {
      std::swap_ranges(A.begin() + static_cast<std::ptrdiff_t>(k * n),
                       A.begin() + static_cast<std::ptrdiff_t>((k + 1) * n),
                       A.begin() + static_cast<std::ptrdiff_t>(pivot * n));
      std::swap(b[k], b[pivot]);
    }
    for (std::size_t i = k + 1; i < n; ++i) {
      const Float128 factor = A[i * n + k] / A[k * n + k];
      if (factor == 0) continue;
      for (std::size_t j = k; j < n; ++j) A[i * n + j] -= factor * A[k * n + j];
      b[i] -= factor * b[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = k + 1; j < n; ++j) b[k] -= A[k * n + j] * b[j];
    b[k] /= A[k * n + k];
  }
}

}  // namespace fw::integrators
