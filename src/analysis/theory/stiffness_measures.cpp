#include "analysis/theory/stiffness_measures.hpp"

#include <cmath>
#include <limits>

#include "dense/eigenvalues.hpp"
#include "linalg/extreme_eigenvalues.hpp"

namespace fw::analysis {

double spectral_radius(const OdeSystem& system, double t, ConstVectorRef y) {
  constexpr Index largest_dense = 200;
  if (system.size() <= largest_dense) return stiffness_measures(system, t, y).largest_eigenvalue;
  SparseMatrix J = system.jacobian_pattern();
  system.jacobian(t, y, J);
  const linalg::ExtremeEigenvalues extreme = linalg::extreme_eigenvalues(J, {.tolerance = 1e-4});
  if (!extreme.status.ok() || extreme.values.empty()) return std::numeric_limits<double>::quiet_NaN();
  return std::abs(extreme.values.front());
}

StiffnessMeasures stiffness_measures(const OdeSystem& system, double t, ConstVectorRef y) {
  SparseMatrix J = system.jacobian_pattern();
  system.jacobian(t, y, J);
  const Eigen::VectorXcd eigenvalues = dense::eigenvalues(Matrix(J));
  StiffnessMeasures measures;
  for (const Complex& value : eigenvalues) {
    measures.largest_eigenvalue = std::max(measures.largest_eigenvalue, std::abs(value));
  }
  const double zero = 1e-8 * measures.largest_eigenvalue;
  const double infinity = std::numeric_limits<double>::infinity();
  double least = infinity, least_decay = infinity, largest_decay = 0.0;
  for (const Complex& value : eigenvalues) {
    if (std::abs(value) > zero) least = std::min(least, std::abs(value));
    if (value.real() < -zero) {
      least_decay = std::min(least_decay, -value.real());
      largest_decay = std::max(largest_decay, -value.real());
    }
  }
  const double none = std::numeric_limits<double>::quiet_NaN();
  measures.eigenvalue_ratio = std::isfinite(least) ? measures.largest_eigenvalue / least : none;
  measures.stiffness_ratio = largest_decay > 0.0 ? largest_decay / least_decay : none;
  return measures;
}

}  // namespace fw::analysis
