#include "integrators/energy_momentum/implicit_velocity.hpp"

#include <algorithm>

namespace fw::integrators {

ImplicitVelocityStepper::ImplicitVelocityStepper(const SecondOrderSystem& system, Work& work)
    : system_(system),
      work_(work),
      newton_(system.degrees_of_freedom()),
      start_position_(system.degrees_of_freedom()),
      start_velocity_(system.degrees_of_freedom()),
      impulse_(system.degrees_of_freedom()) {}

Status ImplicitVelocityStepper::step(double t, double h, VectorRef y) {
  const Index n = impulse_.size();
  time_ = t;
  length_ = h;
  start_position_ = y.head(n);
  start_velocity_ = y.tail(n);
  auto v = y.tail(n);
  const double scale =
      std::max(v.lpNorm<Eigen::Infinity>(), 1e-4 * start_position_.lpNorm<Eigen::Infinity>() / h);
  if (Status status = newton_.solve(*this, v, scale, work_); !status.ok()) return status;
  y.head(n) = start_position_ + (0.5 * h) * (start_velocity_ + v);
  return {};
}

void ImplicitVelocityStepper::residual(ConstVectorRef v, VectorRef out) {
  impulse(v, impulse_);
  out = system_.mass().cwiseProduct(v - start_velocity_) - impulse_;
}

}  // namespace fw::integrators
