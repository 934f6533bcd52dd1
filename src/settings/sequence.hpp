#pragma once

#include <cstdint>
#include <vector>

namespace fw::settings {

/// `count` ≥ 2 numbers from `from` to `to`, both > 0, each the same factor times the one before.
std::vector<double> geometric_sequence(double from, double to, std::int64_t count);

}  // namespace fw::settings
