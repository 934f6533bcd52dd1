#include "integrators/loop/initial_step.hpp"

#include <algorithm>
#include <cmath>

namespace fw::integrators {

double initial_step(const Ivp& ivp, const AdaptiveStep& tolerances, ErrorNorm norm, int order, Work& work) {
  const double length = ivp.t1 - ivp.t0;
  const Vector& y = ivp.y0;
  Vector slope(y.size()), later_slope(y.size());
  ivp.system->rhs(ivp.t0, y, slope);
  const double size = error_in_tolerances(norm, tolerances, y, y, y);
  const double speed = error_in_tolerances(norm, tolerances, slope, y, y);
  constexpr double tiny = 1e-5;
  double guess = size < tiny || speed < tiny ? 1e-6 : 0.01 * size / speed;
  if (!std::isfinite(guess)) guess = 1e-6;  // the first attempt will tell what is wrong with f
  guess = std::min({guess, length, tolerances.maximum_step});
  const Vector moved = y + guess * slope;
  ivp.system->rhs(ivp.t0 + guess, moved, later_slope);
  work.rhs_evaluations += 2;
  later_slope -= slope;
  const double bend = error_in_tolerances(norm, tolerances, later_slope, y, y) / guess;
  const double largest = std::max(speed, bend);
  double step = largest <= 1e-15 ? std::max(1e-6, guess * 1e-3)
                                 : std::pow(0.01 / largest, 1.0 / static_cast<double>(order + 1));
  if (!std::isfinite(step)) step = guess;
  return std::min({100.0 * guess, step, length, tolerances.maximum_step});
}

}  // namespace fw::integrators
