#pragma once

#include <string>

#include "mechanics/mass_spring_system.hpp"
#include "scene/scene.hpp"

namespace fw::app {

/// Where a simulation starts: the state of the scene, its static equilibrium where the scene asks for it, or
/// the last frame of the result file `from` (empty: none) of a system with as many particles. Velocities of
/// fixed particles are zero. Throws InputError that names file or key.
Vector start_state(const scene::Scene& scene, const mechanics::MassSpringSystem& system,
                   const std::string& from);

/// What is known of a constant step before the run.
struct StepAdvice {
  std::string note{};     ///< for standard output; empty: nothing is known
  std::string warning{};  ///< where the step is longer than the largest stable one
};

/// A constant step of the method of a call against the largest step that is stable at the start, in theory.
StepAdvice advise_on_step(const std::string& call, double step, const mechanics::MassSpringSystem& system,
                          ConstVectorRef start);

}  // namespace fw::app
