#include "store/case_groups.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>

#include "store/hdf5/attribute.hpp"
#include "store/hdf5/dataset.hpp"

namespace fw::store {

namespace {

using record::Column;
using study::CaseResult;
using study::SummaryCell;
using study::Verdict;

void check_name(const std::string& name, const std::string& where) {
  if (name.empty() || name == "." || name == ".." ||
      name.find_first_of(std::string_view("/\0", 2)) != name.npos) {
    throw InputError(fmt::format("{}: \"{}\" cannot be a name in a result file", where, name));
  }
}

Shape checked_shape(const Column& column, const std::string& where) {
  const std::size_t count = std::visit([](const auto& values) { return values.size(); }, column.values);
  if (column.shape.empty()) return {count};
  std::uint64_t product = 1;
  for (const std::uint64_t extent : column.shape) product *= extent;
  if (product != count) {
    throw InputError(fmt::format("{}: column \"{}\" has {} values, but its shape holds {}", where,
                                 column.name, count, product));
  }
  return Shape(column.shape.begin(), column.shape.end());
}

void write_column(hid_t group, const Column& column, const std::string& where) {
  check_name(column.name, where);
  const Shape shape = checked_shape(column, where);
  std::visit(
      [&](const auto& values) { write_dataset(group, column.name, column.unit, shape, std::span(values)); },
      column.values);
  if (column.attributes.empty()) return;
  const Handle dataset(H5Dopen2(group, column.name.c_str(), H5P_DEFAULT), H5Dclose, column.name);
  for (const auto& [name, text] : column.attributes) write_attribute(dataset, name, text);
}

std::vector<SummaryCell> full_row(const CaseResult& result) {
  std::vector<SummaryCell> row{{"case", "", result.id}};
  for (const SummaryCell& cell : result.summary) {
    if (cell.name == "case" || cell.name == "verdict" || cell.name == "reason") {
      throw InputError(fmt::format("summary column \"{}\" is written from the case itself", cell.name));
    }
  }
  row.insert(row.end(), result.parameters.begin(), result.parameters.end());
  row.insert(row.end(), result.summary.begin(), result.summary.end());
  row.push_back({"verdict", "", std::string(to_string(result.verdict))});
  row.push_back({"reason", "", result.reason});
  return row;
}

/// Says in words what stands for an integer that is not there.
void mark_missing(Column& column) {
  const auto* values = std::get_if<std::vector<std::int64_t>>(&column.values);
  if (values == nullptr) return;
  if (std::find(values->begin(), values->end(), study::missing_integer) == values->end()) return;
  column.attributes.emplace_back("missing", fmt::format("{}", study::missing_integer));
}

void write_summary(hid_t file, const std::vector<CaseResult>& cases) {
  const Handle group = make_group(file, "summary");
  std::vector<Column> columns;
  for (const CaseResult& result : cases) {
    const std::vector<SummaryCell> row = full_row(result);
    const std::string where = "summary of case \"" + result.id + "\"";
    if (columns.empty()) {
      for (const SummaryCell& cell : row) {
        Column& column = columns.emplace_back();
        column.name = cell.name;
        column.unit = cell.unit;
        std::visit([&]<class T>(const T&) { column.values = std::vector<T>(); }, cell.value);
      }
    }
    if (row.size() != columns.size()) {
      throw InputError(
          fmt::format("{}: {} cells, but the first case has {}", where, row.size(), columns.size()));
    }
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (row[i].name != columns[i].name || row[i].unit != columns[i].unit ||
          row[i].value.index() != columns[i].values.index()) {
        throw InputError(
            fmt::format("{}: cell {} is \"{}\" [{}], which differs from \"{}\" [{}] of the first case", where,
                        i, row[i].name, row[i].unit, columns[i].name, columns[i].unit));
      }
      std::visit(
          [&]<class T>(const T& value) { std::get<std::vector<T>>(columns[i].values).push_back(value); },
          row[i].value);
    }
  }
  for (Column& column : columns) {
    mark_missing(column);
    write_column(group, column, "summary");
  }
}

Verdict verdict_of(const std::string& text) {
  for (const Verdict verdict : {Verdict::holds, Verdict::fails, Verdict::done}) {
    if (text == to_string(verdict)) return verdict;
  }
  return Verdict::not_applicable;
}

}  // namespace

void write_cases(hid_t file, const std::vector<CaseResult>& cases) {
  const Handle group = make_group(file, "cases");
  std::set<std::string> ids;
  for (const CaseResult& result : cases) {
    check_name(result.id, "case");
    if (!ids.insert(result.id).second) throw InputError("case \"" + result.id + "\" is there twice");
    const Handle place = make_group(group, result.id);
    write_attribute(place, "key", result.key);
    write_attribute(place, "verdict", std::string(to_string(result.verdict)));
    write_attribute(place, "reason", result.reason);
    for (const Column& column : result.columns) write_column(place, column, "case \"" + result.id + "\"");
  }
  write_summary(file, cases);
}

std::vector<Column> read_summary(hid_t file) {
  std::vector<Column> columns;
  if (!has_link(file, "summary")) {
    if (has_link(file, "cases") && !link_names(open_group(file, "cases")).empty()) {
      throw LibraryError("the summary is missing");
    }
    return columns;
  }
  const Handle group = open_group(file, "summary");
  for (const std::string& name : link_names(group)) columns.push_back(read_dataset(group, name));
  const auto rows = [](const Column& column) {
    return std::visit([](const auto& values) { return values.size(); }, column.values);
  };
  for (const Column& column : columns) {
    if (rows(column) == rows(columns.front())) continue;
    throw LibraryError(fmt::format("summary column \"{}\" has {} rows, \"{}\" has {}", column.name,
                                   rows(column), columns.front().name, rows(columns.front())));
  }
  return columns;
}

std::vector<CaseResult> read_cases(hid_t file) {
  std::vector<CaseResult> cases;
  const Handle group = open_group(file, "cases");
  for (const std::string& id : link_names(group)) {
    const Handle place = open_group(group, id);
    const Attributes attributes = read_attributes(place);
    CaseResult& result = cases.emplace_back();
    result.id = id;
    result.key = text_of(attributes, "key");
    result.verdict = verdict_of(text_of(attributes, "verdict"));
    result.reason = text_of(attributes, "reason");
    for (const std::string& name : link_names(place)) result.columns.push_back(read_dataset(place, name));
  }
  const std::vector<Column> summary = read_summary(file);
  if (summary.empty() && !cases.empty()) throw LibraryError("the summary is missing");
  for (const Column& column : summary) {
    std::visit(
        [&](const auto& values) {
          if (values.size() != cases.size()) {
            throw LibraryError(fmt::format("summary column \"{}\" has {} rows for {} cases", column.name,
                                           values.size(), cases.size()));
          }
          if (column.name == "case" || column.name == "verdict" || column.name == "reason") return;
          const bool is_parameter = column.name.starts_with(study::parameter_prefix);
          for (std::size_t i = 0; i < values.size(); ++i) {
            auto& row = is_parameter ? cases[i].parameters : cases[i].summary;
            row.push_back({column.name, column.unit, values[i]});
          }
        },
        column.values);
  }
  return cases;
}

}  // namespace fw::store
