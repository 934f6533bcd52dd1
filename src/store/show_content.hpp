#pragma once

#include <array>
#include <filesystem>
#include <variant>

#include "store/hdf5/attribute.hpp"
#include "store/trajectory_summary.hpp"
#include "study/result.hpp"

namespace fw::store {

/// The summary of a study with its verdicts counted.
struct StudySummary {
  Attributes attributes;  ///< of the root
  std::vector<record::Column> columns;
  std::array<std::int64_t, 4> verdicts{};  ///< holds, fails, not applicable, done
};

/// What `show` says about a file, read but not yet put into words.
using ShowContent = std::variant<StudySummary, TrajectorySummary>;

/// Throws InputError that names the file.
ShowContent read_show_content(const std::filesystem::path& path);

}  // namespace fw::store
