#pragma once

#include <cstdint>

#include "core/status.hpp"
#include "core/types.hpp"

namespace fw::integrators {

/// Whether y is finite and below every physical size: non_finite or blow_up otherwise, naming step and time.
Status check_state(ConstVectorRef y, double t, std::uint64_t step);

}  // namespace fw::integrators
