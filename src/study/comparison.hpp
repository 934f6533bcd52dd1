#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "study/result.hpp"

namespace fw::study {

/// Whether a column holds what the machine measured, seconds or bytes, which differs from run to run: its
/// name has "seconds" or "memory" in it. All other numbers are the same bit for bit whenever a study runs.
bool is_measured(std::string_view column);

/// What two runs of the same study differ in.
struct Comparison {
  std::size_t cases = 0;                   ///< in both
  std::size_t columns = 0;                 ///< compared, of cases and summary
  std::vector<std::string> differences{};  ///< one sentence each, which names case and column
};

/// Compares every column of every case and of the summary bit for bit (a NaN equals a NaN) with its unit,
/// shape and attributes, and the verdicts; measured columns and `reason`, which repeats numbers, are left
/// out. A case that could not be computed in one of them is a difference, so is a case of `before` that is
/// not in `after`, and one that is only in `after`, if `before` is complete.
Comparison compare(const StudyResult& before, const StudyResult& after);

}  // namespace fw::study
