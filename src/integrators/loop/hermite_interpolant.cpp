#include "integrators/loop/hermite_interpolant.hpp"

namespace fw::integrators {

void HermiteInterpolant::set_step(double t, double t_next, ConstVectorRef start, ConstVectorRef end) {
  start_time_ = t;
  end_time_ = t_next;
  start_ = start.data();
  end_ = end.data();
  has_slopes_ = false;
}

void HermiteInterpolant::operator()(double t, VectorRef out) {
  const ConstVectorMap start(start_, system_.size()), end(end_, system_.size());
  if (!has_slopes_) {
    start_slope_.resize(system_.size());
    end_slope_.resize(system_.size());
    system_.rhs(start_time_, start, start_slope_);
    system_.rhs(end_time_, end, end_slope_);
    work_.rhs_evaluations += 2;
    has_slopes_ = true;
  }
  const double h = end_time_ - start_time_;
  const double s = (t - start_time_) / h;
  const double r = 1.0 - s;
  // In differences: a component that rests at both ends rests in between, to the last bit.
  out = start + (s * s * (1.0 + 2.0 * r)) * (end - start) + (h * s * r) * (r * start_slope_ - s * end_slope_);
}

}  // namespace fw::integrators
