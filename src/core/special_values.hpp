#pragma once

#include <limits>

namespace fw {

/// The value of a figure that does not exist or is not known: not a number.
inline constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

inline constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace fw
