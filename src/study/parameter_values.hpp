#pragma once

#include <vector>

#include "text/checked_table.hpp"

namespace fw::study {

/// The numbers that a section lists as `values`, or as the geometric sequence `from`, `to`, `count` (both >
/// 0, both included), sorted by magnitude: laws are fitted and crossings found along them. Throws InputError,
/// also for a number that is there twice.
std::vector<double> read_parameter_values(const CheckedTable& section);

}  // namespace fw::study
