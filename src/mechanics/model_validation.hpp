#pragma once

#include "mechanics/mass_spring_model.hpp"

namespace fw::mechanics {

/// Checks every parameter of `model`: sizes, index ranges, signs, finiteness. Throws InputError that names
/// the array, the index, what was found and what was expected.
void validate(const MassSpringModel& model);

}  // namespace fw::mechanics
