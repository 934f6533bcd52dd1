#include "store/show_content.hpp"

#include <fmt/format.h>

#include "store/case_groups.hpp"
#include "store/input_file.hpp"

namespace fw::store {

ShowContent read_show_content(const std::filesystem::path& path) {
  const LibraryLock lock;
  const InputFile file(path);
  if (has_link(file.id(), "trajectory")) return read_trajectory_summary(path);
  StudySummary summary;
  summary.attributes = file.attributes();
  try {
    summary.columns = read_summary(file.id());
  } catch (const LibraryError& error) {
    throw InputError(fmt::format("\"{}\" is damaged: {}", path.string(), error.what()));
  }
  for (const record::Column& column : summary.columns) {
    const auto* texts = std::get_if<std::vector<std::string>>(&column.values);
    if (column.name != "verdict" || texts == nullptr) continue;
    for (const std::string& text : *texts) {
      if (text == "holds") ++summary.verdicts[0];
      if (text == "fails") ++summary.verdicts[1];
      if (text == "not applicable") ++summary.verdicts[2];
      if (text == "done") ++summary.verdicts[3];
    }
  }
  return summary;
}

}  // namespace fw::store
