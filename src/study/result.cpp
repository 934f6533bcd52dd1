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

void replace_cell(CaseResult& result, std::string_view name, CellValue value) {
  named(result.summary, result.id, name).value = std::move(value);
}

std::string row_mismatch(const std::vector<SummaryColumn>& columns, const std::vector<SummaryCell>& row) {
  for (std::size_t k = 0; k < std::min(columns.size(), row.size()); ++k) {
    if (row[k].name != columns[k].name || row[k].unit != columns[k].unit) {
      return fmt::format("cell {} is \"{}\" [{}], expected \"{}\" [{}]", k, row[k].name, row[k].unit,
                         columns[k].name, columns[k].unit);
    }
    if (row[k].value.index() != static_cast<std::size_t>(columns[k].type)) {
      return fmt::format("cell {}, \"{}\", has another type than the kind declares", k, row[k].name);
    }
  }
  if (columns.size() == row.size()) return "";
  return fmt::format("found {} cells, expected {}", row.size(), columns.size());
}

std::vector<SummaryCell> missing_row(const std::vector<SummaryColumn>& columns,
                                     const std::vector<std::pair<std::string, CellValue>>& known) {
  std::vector<SummaryCell> row;
  for (const SummaryColumn& column : columns) {
    CellValue nothing = std::numeric_limits<double>::quiet_NaN();
    if (column.type == CellType::integer) nothing = missing_integer;
    if (column.type == CellType::text) nothing = std::string();
    row.push_back({column.name, column.unit, std::move(nothing)});
  }
  for (const auto& [name, value] : known) {
    SummaryCell& cell = named(row, "that could not be computed", name);
    if (cell.value.index() != value.index())
      throw std::logic_error(
          fmt::format("\"{}\" of a planned case has another type than the kind declares", name));
    cell.value = value;
  }
  return row;
}

}  // namespace fw::study
