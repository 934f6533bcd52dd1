#pragma once

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "study/result.hpp"

namespace fw::study {

/// Walks over the declaration of a summary row.
///
/// A kind of study declares the row of its summary once, by a function that names every column with its unit,
/// the value that a case has, and what it means:
/// ```
/// void declare(SummaryRow& a, const Row& row) {
///   a("problem", "", row.problem, "its label");
///   a("order", "1", row.order, "slope of the error over the step; NaN where there is no fit");
/// }
/// ```
/// From it come the columns of the kind, against which each case is checked when it returns, the cells of a
/// case, and the table in docs/results_schema.md. `verdict` and `reason` are no cells: they are fields of a
/// result, which the store writes last.
class SummaryRow {
 public:
  /// A value is a number, an integer or a text.
  template <class Value>
  void operator()(std::string name, std::string unit, const Value& value, std::string meaning) {
    if constexpr (std::is_same_v<Value, double>) {
      add(std::move(name), std::move(unit), value, std::move(meaning));
    } else if constexpr (std::is_integral_v<Value>) {
      add(std::move(name), std::move(unit), static_cast<std::int64_t>(value), std::move(meaning));
    } else {
      add(std::move(name), std::move(unit), std::string(value), std::move(meaning));
    }
  }

  const std::vector<SummaryColumn>& columns() const { return columns_; }
  const std::vector<SummaryCell>& cells() const { return cells_; }

 private:
  void add(std::string name, std::string unit, CellValue value, std::string meaning) {
    columns_.push_back({name, unit, static_cast<CellType>(value.index()), std::move(meaning)});
    cells_.push_back({std::move(name), std::move(unit), std::move(value)});
  }

  std::vector<SummaryColumn> columns_;
  std::vector<SummaryCell> cells_;
};

/// The columns that a row's declaration names.
template <class Row>
std::vector<SummaryColumn> columns_of() {
  SummaryRow row;
  declare(row, Row{});
  return row.columns();
}

/// The cells of a case.
template <class Row>
std::vector<SummaryCell> cells_of(const Row& values) {
  SummaryRow row;
  declare(row, values);
  return row.cells();
}

/// What a case ends with: a verdict, the reason for it, raw data and the row of its kind. The runner adds id
/// and key.
template <class Row>
CaseResult case_result(Verdict verdict, std::string reason, std::vector<Column> columns, const Row& row) {
  CaseResult result;
  result.columns = std::move(columns);
  result.summary = cells_of(row);
  result.verdict = verdict;
  result.reason = std::move(reason);
  return result;
}

}  // namespace fw::study
