#pragma once

#include <vector>

#include "store/hdf5/hdf5_library.hpp"
#include "study/result.hpp"

namespace fw::store {

/// Writes /cases/<id>/<column> and /summary/<column>, one row per case in their order. The summary gets a
/// first column `case` with the ids, and `verdict` and `reason` where the cells do not hold them. Throws
/// InputError if ids repeat or cannot be names, if a shape does not fit its values, or if the cells of two
/// cases differ in name, unit or type; LibraryError.
void write_cases(hid_t file, const std::vector<study::CaseResult>& cases);

/// The inverse of `write_cases`; the summary cells then always hold `verdict` and `reason`. Throws
/// LibraryError if something is missing.
std::vector<study::CaseResult> read_cases(hid_t file);

/// The columns of /summary, empty if there is none. Throws LibraryError.
std::vector<record::Column> read_summary(hid_t file);

}  // namespace fw::store
