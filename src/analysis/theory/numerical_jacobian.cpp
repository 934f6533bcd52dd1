#include "analysis/theory/numerical_jacobian.hpp"

#include <vector>

namespace fw::analysis {

Matrix complex_step_jacobian(const OdeSystem& system, double t, ConstVectorRef y) {
  constexpr double step = 1e-200;
  const auto size = static_cast<std::size_t>(y.size());
  std::vector<Complex> state(y.data(), y.data() + y.size()), slope(size);
  Matrix J(y.size(), y.size());
  for (std::size_t j = 0; j < size; ++j) {
    state[j].imag(step);
    system.rhs(t, std::span<const Complex>(state), std::span<Complex>(slope));
    state[j].imag(0.0);
    for (std::size_t i = 0; i < size; ++i) {
      J(static_cast<Index>(i), static_cast<Index>(j)) = slope[i].imag() / step;
    }
  }
  return J;
}

Matrix difference_jacobian(const OdeSystem& system, double t, ConstVectorRef y, double increment,
                           Difference difference) {
  const Index n = y.size();
  Vector state = y, forward(n), backward(n);
  if (difference == Difference::forward) system.rhs(t, y, backward);
  Matrix J(n, n);
  for (Index j = 0; j < n; ++j) {
    state[j] = y[j] + increment;
    system.rhs(t, state, forward);
    if (difference == Difference::central) {
      state[j] = y[j] - increment;
      system.rhs(t, state, backward);
    }
    state[j] = y[j];
    const double distance = difference == Difference::forward ? increment : 2.0 * increment;
    J.col(j) = (forward - backward) / distance;
  }
  return J;
}

Matrix analytic_jacobian(const OdeSystem& system, double t, ConstVectorRef y) {
  SparseMatrix J = system.jacobian_pattern();
  system.jacobian(t, y, J);
  return J;
}

}  // namespace fw::analysis
