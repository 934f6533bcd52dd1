#pragma once

#include "study/problem_spec.hpp"

namespace fw::study {

/// Masses at rest of which one is disturbed, with the number of springs from there to each of the others.
struct DisturbedNetwork {
  std::string label, identity;
  Ivp ivp;                    ///< y0 holds the disturbance
  Vector rest;                ///< positions without it
  Index coordinates = 1;      ///< per mass
  Index disturbed = 0;        ///< the mass
  std::vector<int> distance;  ///< springs from the disturbed mass; −1 where none lead there over free masses
  int farthest = 0;
  bool is_kicked = true;     ///< a velocity is given, else a displacement
  bool has_dampers = false;  ///< in springs of a scene
  /// √(k/m) of a linear chain: springs per second that long waves travel; NaN of scenes.
  double wave_speed = 0.0;

  Index masses() const { return static_cast<Index>(distance.size()); }
};

/// `mass` −1: the middle one. The chain of the catalogue starts from rest instead of its own initial state; a
/// scene from its own positions without velocities, in which every force has to be exactly zero. `direction`
/// is that of the disturbance in a scene. Throws InputError.
DisturbedNetwork disturb(const StudyProblem& problem, std::int64_t mass, bool kick, double size,
                         const Vec3<double>& direction);

}  // namespace fw::study
