#include "analysis/theory/numerical_jacobian.hpp"

#include <vector>

#include "ode/complex_step.hpp"

namespace fw::analysis {

Matrix complex_step_jacobian(const OdeSystem& system, double t, ConstVectorRef y) {
  Matrix J(y.size(), y.size());
  fw::complex_step_jacobian(
      y, static_cast<std::size_t>(y.size()), 0, y.size(),
      [&](const std::vector<Complex>& state, std::vector<Complex>& slope) {
        system.rhs(t, std::span<const Complex>(state), std::span<Complex>(slope));
      },
      [&J](Index i, Index j, double value) { J(i, j) = value; });
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
