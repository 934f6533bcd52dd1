#include "analysis/fit/gregory_quadrature.hpp"

#include <algorithm>
#include <cmath>

namespace fw::analysis {

namespace {

/// Of the differences of order 1 to 6.
constexpr double gregory_coefficients[] = {1.0 / 12.0,  1.0 / 24.0,      19.0 / 720.0,
                                           3.0 / 160.0, 863.0 / 60480.0, 275.0 / 24192.0};

/// Σ_k G_k times the k-th difference of `values`, seen from values[0] inwards with alternating signs: at the
/// start that is (−1)^k Δ^k f_0, at the end ∇^k f_N.
template <std::size_t N>
double end_correction(std::array<double, N> values, std::size_t orders) {
  double sum = 0.0;
  for (std::size_t k = 0; k < orders; ++k) {
    for (std::size_t i = 0; i + k + 1 < N; ++i) values[i] = values[i] - values[i + 1];
    sum += gregory_coefficients[k] * values[0];
  }
  return sum;
}

}  // namespace

void GregoryQuadrature::add(double value) {
  if (count_ < kept) first_[static_cast<std::size_t>(count_)] = value;
  std::copy_backward(last_.begin(), last_.end() - 1, last_.end());
  last_[0] = value;
  ++count_;
  const double next = sum_ + value;
  compensation_ += std::abs(sum_) >= std::abs(value) ? (sum_ - next) + value : (value - next) + sum_;
  sum_ = next;
}

double GregoryQuadrature::integral(double step) const {
  if (count_ < 2) return 0.0;
  const auto orders = static_cast<std::size_t>(std::min<std::uint64_t>(count_ - 1, kept - 1));
  const double ends = 0.5 * (first_[0] + last_[0]);
  return step *
         ((sum_ - ends) + compensation_ - end_correction(first_, orders) - end_correction(last_, orders));
}

}  // namespace fw::analysis
