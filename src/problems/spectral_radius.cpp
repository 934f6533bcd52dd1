#include "problems/spectral_radius.hpp"

#include <algorithm>
#include <cmath>

#include "dense/eigenvalues.hpp"
#include "dense/factorisations.hpp"

namespace fw::problems {

double spectral_radius_along_solution(const Ivp& ivp) {
  constexpr int step_limit = 5000;
  constexpr double tolerance = 1e-3;
  const double d = 1.0 / (2.0 + std::sqrt(2.0));
  const double e32 = 6.0 + std::sqrt(2.0);
  const OdeSystem& system = *ivp.system;
  const Index n = system.size();

  SparseMatrix sparse = system.jacobian_pattern();
  Vector y = ivp.y0, f0(n), f1(n), f2(n), shifted(n), y_new(n);
  Vector scale = y.cwiseAbs();
  Vector sampled_at;
  double radius = 0.0;
  double t = ivp.t0;
  double h = 1e-3 * (ivp.t1 - ivp.t0);
  bool fresh = false;  // f0 and J belong to (t, y)
  Matrix J;
  Vector time_derivative;

  for (int step = 0; step < step_limit && t < ivp.t1; ++step) {
    h = std::min(h, ivp.t1 - t);
    if (!fresh) {
      system.rhs(t, y, f0);
      system.jacobian(t, y, sparse);
      J = Matrix(sparse);
      if (!J.allFinite()) break;
      const double delta = 1e-7 * h;
      system.rhs(t + delta, y, shifted);
      time_derivative = (shifted - f0) / delta;
      scale = scale.cwiseMax(y.cwiseAbs());
      const double largest = std::max(scale.maxCoeff(), 1e-300);
      if (sampled_at.size() == 0 ||
          ((y - sampled_at).array().abs() / (scale.array() + 1e-6 * largest)).maxCoeff() > 0.02) {
        radius = std::max(radius, dense::eigenvalues(J).cwiseAbs().maxCoeff());
        sampled_at = y;
      }
      fresh = true;
    }
    const dense::Lu W(Matrix::Identity(n, n) - h * d * J);
    const Vector k1 = W.solve(f0 + h * d * time_derivative);
    system.rhs(t + 0.5 * h, y + 0.5 * h * k1, f1);
    const Vector k2 = W.solve(f1 - k1) + k1;
    y_new = y + h * k2;
    system.rhs(t + h, y_new, f2);
    const Vector k3 = W.solve(f2 - e32 * (k2 - f1) - 2.0 * (k1 - f0) + h * d * time_derivative);
    const double largest = std::max({scale.maxCoeff(), y_new.cwiseAbs().maxCoeff(), 1e-300});
    const double error = ((h / 6.0) * (k1 - 2.0 * k2 + k3)).cwiseAbs().maxCoeff() / (tolerance * largest);
    if (!std::isfinite(error)) {
      h *= 0.1;
      if (t + h == t) break;
      continue;
    }
    if (error <= 1.0) {
      t = h < ivp.t1 - t ? t + h : ivp.t1;
      y = y_new;
      fresh = false;
    }
    h *= std::clamp(0.8 * std::cbrt(1.0 / std::max(error, 1e-12)), 0.2, 4.0);
  }
  return radius;
}

}  // namespace fw::problems
