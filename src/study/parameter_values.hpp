#pragma once

#include <cstddef>
#include <optional>
#include <utility>
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

/// At most `most` of the indices 0 … size − 1, ascending and evenly spread, the first and, for two or more, the
/// last among them; `most` is at least 1.
std::vector<std::size_t> spread_indices(std::size_t size, std::size_t most);

/// The entries at `spread_indices`: what `--quick` leaves of a list.
template <class Entry>
std::vector<Entry> thinned_out(std::vector<Entry> entries, std::int64_t most) {
  std::vector<Entry> kept;
  for (const std::size_t k : spread_indices(entries.size(), static_cast<std::size_t>(most))) {
    kept.push_back(std::move(entries[k]));
  }
  return kept;
}

}  // namespace fw::study
