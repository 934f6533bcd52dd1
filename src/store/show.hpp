#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace fw::store {

/// A result file for people at a terminal: what it is, then the summary table and the verdicts of a study, or
/// times, sizes, energies and work of a trajectory, then where it comes from. `columns` are those of the
/// summary table, in this order; empty: all that are no details, the reason last. No line is longer than
/// `width` code points; with 0 they are as long as they have to be. Throws InputError that names the file.
std::string show(const std::filesystem::path& path, const std::vector<std::string>& columns = {},
                 std::size_t width = 0);

/// The same as one JSON object: `file`, `attributes` (all of the root), and `summary` (an array of objects,
/// one per case) with `units` and `verdicts`, or `trajectory` with `counters`. Numbers that are not finite
/// are null. Throws InputError.
std::string show_json(const std::filesystem::path& path);

}  // namespace fw::store
