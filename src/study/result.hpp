#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/verdict.hpp"
#include "record/column.hpp"

namespace fw::study {

using fw::Verdict;
using record::Column;
using record::ColumnValues;

/// One cell of a summary row.
struct SummaryCell {
  std::string name;
  std::string unit;
  std::variant<double, std::int64_t, std::string> value;
};

/// What one case of a study found. `columns` are its raw data, `summary` is its row of the summary (the same
/// names, units and types, in the same order, in every case of a study; "verdict" and "reason" among them).
struct CaseResult {
  std::string id;   ///< group name in the file, unique in the study: "<problem>-<method>", no '/'
  std::string key;  ///< SHA-256 of the resolved case: what makes it the same case in another run; empty if it
                    ///< could not be computed
  std::vector<Column> columns;
  std::vector<SummaryCell> summary;
  Verdict verdict = Verdict::not_applicable;
  std::string reason;
};

/// The column or cell of that name; throws std::logic_error where the case has none.
const Column& column_of(const CaseResult& result, std::string_view name);
const SummaryCell& cell_of(const CaseResult& result, std::string_view name);

/// The values of a column as numbers.
std::vector<double> numbers_of(const CaseResult& result, std::string_view name);
/// The text of a cell.
const std::string& text_of(const CaseResult& result, std::string_view name);

/// Puts a column or cell in the place of the one of that name; a cell has to be there, a column is added.
void replace_column(CaseResult& result, Column column);
void replace_cell(CaseResult& result, std::string_view name,
                  std::variant<double, std::int64_t, std::string> value);

/// The result of a study: everything a result file holds but its provenance.
struct StudyResult {
  std::string kind;  ///< for example "convergence"
  std::string title;
  std::string spec;  ///< the resolved input as TOML text
  std::int64_t seed = 0;
  bool quick = false;    ///< shrunk by its own [quick] section
  bool complete = true;  ///< false if cases are missing (interrupted)
  std::vector<CaseResult> cases;
};

}  // namespace fw::study
