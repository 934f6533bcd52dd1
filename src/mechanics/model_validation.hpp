#pragma once

#include "mechanics/mass_spring_model.hpp"

namespace fw::mechanics {

/// Checks masses and fixed particles of `model`: sizes, index ranges, signs, finiteness. Throws InputError
/// that names the array, the index, what was found and what was expected. Force elements check themselves
/// where they are assembled.
void validate_particles(const MassSpringModel& model);

}  // namespace fw::mechanics
