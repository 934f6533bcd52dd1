#pragma once

#include <optional>
#include <vector>

#include "settings/archive.hpp"

namespace fw::study {

/// Numbers listed as `values`, or the geometric sequence `from`, `to`, `count` (both > 0, both included).
struct ParameterValues {
  std::optional<std::vector<double>> values;
  std::optional<double> from, to;
  std::optional<std::int64_t> count;
};
void declare(settings::Archive& a, ParameterValues& values);
/// The form `from`, `to`, `count` alone.
void declare_sequence(settings::Archive& a, ParameterValues& values);

/// The numbers in the order in which they were given.
std::vector<double> sequence_of(const ParameterValues& given);

/// The numbers sorted by magnitude: laws are fitted and crossings found along them. Throws InputError for one
/// that is there twice, in `section`.
std::vector<double> sorted_values(const ParameterValues& given, const CheckedTable& section);

}  // namespace fw::study
