#pragma once

#include <gsl/gsl_sf_ellint.h>
#include <gsl/gsl_sf_elljac.h>

#include <cmath>
#include <memory>

#include "constraints/distance_constraints.hpp"
#include "mechanics/mass_spring_system.hpp"
#include "ode/ivp.hpp"

namespace fw::oracles {

/// A mathematical pendulum of rod length L that is released at rest at the angle θ₀ from the vertical, in the
/// plane x–z, and its exact motion in Jacobi's elliptic functions with the parameter m = k²:
///   sin(θ/2) = k cd(ωt), k = sin(θ₀/2), ω = √(g/L), period 4 K(k)/ω.
class Pendulum {
 public:
  Pendulum(double amplitude, double length = 0.8, double mass = 1.7)
      : length_(length), mass_(mass), k_(std::sin(0.5 * amplitude)), omega_(std::sqrt(gravity_ / length)) {
    mechanics::MassSpringModel model;
    model.mass = {1.0, mass_};
    model.fixed = {0};
    model.gravity = {0.0, 0.0, -gravity_};
    system_ = std::make_shared<const mechanics::MassSpringSystem>(model);
  }

  double period() const { return 4.0 * gsl_sf_ellint_Kcomp(k_, GSL_PREC_DOUBLE) / omega_; }

  struct Motion {
    Vector state;    ///< (q, v), 12 entries
    double tension;  ///< of the rod [N], > 0 where it is pulled
  };
  Motion at(double t) const {
    double sn = 0.0, cn = 0.0, dn = 0.0;
    gsl_sf_elljac_e(omega_ * t, k_ * k_, &sn, &cn, &dn);
    const double half = std::asin(k_ * cn / dn);
    const double rate = -2.0 * k_ * omega_ * (1.0 - k_ * k_) * sn / (dn * dn) / std::cos(half);
    const double theta = 2.0 * half;
    Motion motion{Vector::Zero(12), mass_ * (gravity_ * std::cos(theta) + length_ * rate * rate)};
    motion.state[3] = length_ * std::sin(theta);
    motion.state[5] = -length_ * std::cos(theta);
    motion.state[9] = length_ * rate * std::cos(theta);
    motion.state[11] = length_ * rate * std::sin(theta);
    return motion;
  }

  Ivp ivp(double periods) const {
    Ivp ivp;
    ivp.system = system_;
    ivp.t1 = periods * period();
    ivp.y0 = at(0.0).state;
    return ivp;
  }
  constraints::DistanceConstraints rod() const { return {*system_, {{0, 1, length_}}}; }

 private:
  static constexpr double gravity_ = 9.81;
  double length_, mass_, k_, omega_;
  std::shared_ptr<const mechanics::MassSpringSystem> system_;
};

}  // namespace fw::oracles
