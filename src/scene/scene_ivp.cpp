#include <fmt/format.h>

#include <cmath>

#include "core/error.hpp"
#include "mechanics/mass_spring_system.hpp"
#include "scene/scene.hpp"

namespace fw::scene {

Ivp make_ivp(const Scene& scene, double end_time) {
  if (!std::isfinite(end_time) || end_time <= 0.0) {
    throw InputError(fmt::format("end time: found {}, expected a finite number > 0", end_time));
  }
  return {
      std::make_shared<mechanics::MassSpringSystem>(scene.model), 0.0, end_time, initial_state(scene), {}};
}

}  // namespace fw::scene
