#include "integrators/tableau/extended_precision_steps.hpp"

#include <utility>

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

ExtendedLu::ExtendedLu(std::vector<Float128> A, std::size_t size) : size_(size), factors_(std::move(A)) {
  const std::size_t n = size_;
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i) {
      if (abs(factors_[i * n + k]) > abs(factors_[pivot * n + k])) pivot = i;
    }
    pivots_.push_back(pivot);
    for (std::size_t j = 0; pivot != k && j < n; ++j) std::swap(factors_[k * n + j], factors_[pivot * n + j]);
    for (std::size_t i = k + 1; i < n; ++i) {
      const Float128 factor = factors_[i * n + k] / factors_[k * n + k];
      factors_[i * n + k] = factor;
      if (factor == 0) continue;
      for (std::size_t j = k + 1; j < n; ++j) factors_[i * n + j] -= factor * factors_[k * n + j];
    }
  }
}

void ExtendedLu::solve(std::vector<Float128>& b) const {
  const std::size_t n = size_;
  for (std::size_t k = 0; k < n; ++k) std::swap(b[k], b[pivots_[k]]);
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = k + 1; i < n; ++i) {
      if (factors_[i * n + k] != 0) b[i] -= factors_[i * n + k] * b[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = k + 1; j < n; ++j) b[k] -= factors_[k * n + j] * b[j];
    b[k] /= factors_[k * n + k];
  }
}

}  // namespace fw::integrators
