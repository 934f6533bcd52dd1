#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "mechanics/mass_spring_system.hpp"
#include "ode/ivp.hpp"

namespace fw::study {

/// A system and a state at which its derivatives are looked at.
struct JacobianSample {
  std::shared_ptr<const OdeSystem> system;
  double time = 0.0;
  Vector state;
};

/// Random single springs between two free masses.
struct SpringSampling {
  mechanics::SpringLaw law = mechanics::SpringLaw::hooke;
  bool is_damped = false;
};

/// `count` springs from `seed`: lengths about 1 m (0.2 m at least), rest lengths 0.3…2 m, so that many are
/// compressed, k_s in 1…100 N/m, k_d in 0.1…5 N·s/m, masses 0.2…3 kg, velocities to 2 m/s per component.
std::vector<JacobianSample> random_springs(const SpringSampling& sampling, std::int64_t count,
                                           std::int64_t seed);

/// `count` states: the initial state, each moving component displaced by a random number within
/// ±`displacement`.
std::vector<JacobianSample> displaced_states(const Ivp& ivp, std::int64_t count, double displacement,
                                             std::int64_t seed);

/// The mean rest length [m] of a mass-spring system's springs; 1 of any other system.
double typical_length(const OdeSystem& system);

/// How an initial state is compressed.
struct Compression {
  double compression = 1.0;   ///< factor of all distances from the centre of the positions
  double closing_rate = 0.0;  ///< [1/s]: velocities −rate·(x − centre)
  double displacement = 0.0;  ///< [m]: largest random displacement of a moving component, before compressing
  double speed = 0.0;         ///< [m/s]: largest random velocity of a moving component, added
  std::int64_t seed = 0;
};

/// The problem from the compressed state. Fixed particles are compressed as well, and stand still.
Ivp compressed(Ivp ivp, const Compression& start);

/// L/l₀ of the most compressed spring; NaN without springs.
double least_length_ratio(const OdeSystem& system, ConstVectorRef y);

}  // namespace fw::study
