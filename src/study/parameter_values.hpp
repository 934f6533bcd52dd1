#pragma once

#include <vector>

#include "core/checked_table.hpp"

namespace fw::study {

/// The numbers that a section lists as `values`, or as the geometric sequence `from`, `to`, `count` (both >
/// 0, both included). Throws InputError.
std::vector<double> read_parameter_values(const CheckedTable& section);

}  // namespace fw::study
