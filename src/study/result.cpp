#include "study/result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace fw::study {

namespace {

/// The member of that name, in a constant or a mutable list.
template <class Members>
auto& named(Members& members, const std::string& id, std::string_view name) {
  const auto found = std::find_if(members.begin(), members.end(),
                                  [name](const auto& member) { return member.name == name; });
  if (found == members.end()) throw std::logic_error(fmt::format("case {} has no \"{}\"", id, name));
  return *found;
}

}  // namespace

const Column& column_of(const CaseResult& result, std::string_view name) {
  return named(result.columns, result.id, name);
}

const SummaryCell& cell_of(const CaseResult& result, std::string_view name) {
  return named(result.summary, result.id, name);
}

std::vector<double> numbers_of(const CaseResult& result, std::string_view name) {
  const ColumnValues& values = column_of(result, name).values;
  if (const auto* counts = std::get_if<std::vector<std::int64_t>>(&values)) {
    return {counts->begin(), counts->end()};
  }
  return std::get<std::vector<double>>(values);
}

const std::string& text_of(const CaseResult& result, std::string_view name) {
  return std::get<std::string>(cell_of(result, name).value);
}

void replace_column(CaseResult& result, Column column) {
  const auto found = std::find_if(result.columns.begin(), result.columns.end(),
                                  [&](const Column& other) { return other.name == column.name; });
  if (found == result.columns.end()) {
    result.columns.push_back(std::move(column));
  } else {
    *found = std::move(column);
  }
}

void replace_cell(CaseResult& result, std::string_view name,
                  std::variant<double, std::int64_t, std::string> value) {
  named(result.summary, result.id, name).value = std::move(value);
}

}  // namespace fw::study
