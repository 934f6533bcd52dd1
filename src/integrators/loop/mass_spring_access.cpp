#include "integrators/loop/mass_spring_access.hpp"

#include <fmt/format.h>

#include "ode/not_applicable.hpp"

namespace fw::integrators {

const mechanics::MassSpringSystem& require_mass_spring_system(const OdeSystem& system,
                                                              std::string_view method) {
  const auto* springs = dynamic_cast<const mechanics::MassSpringSystem*>(&system);
  if (springs == nullptr) {
    throw NotApplicable(
        fmt::format("method \"{}\": the method needs the springs of a mass-spring system", method));
  }
  return *springs;
}

}  // namespace fw::integrators
