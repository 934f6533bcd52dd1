#pragma once

#include <string_view>

#include "mechanics/mass_spring_system.hpp"

namespace fw::integrators {

/// The mass-spring system behind `system`, for schemes that look at single springs. Throws InputError that
/// names `method` where there is none.
const mechanics::MassSpringSystem& require_mass_spring_system(const OdeSystem& system,
                                                              std::string_view method);

}  // namespace fw::integrators
