#pragma once

#include <cstdint>
#include <limits>
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

using CellValue = std::variant<double, std::int64_t, std::string>;

/// The value of a cell of integers that a case does not have; NaN and the empty text in other cells. A file
/// marks columns with it by the attribute `missing`.
using record::missing_integer;

/// One cell of a summary row.
struct SummaryCell {
  std::string name;
  std::string unit;
  CellValue value;
};

/// The types of cells, in the order of `CellValue`.
enum class CellType { number, integer, text };

/// What a kind of study declares of a column of its summary.
struct SummaryColumn {
  std::string name;
  std::string unit;
  CellType type = CellType::number;
  std::string meaning;  ///< in Markdown
};

/// Columns of the values of parameters, which a sweep puts before those of a kind, have names that begin so.
inline constexpr std::string_view parameter_prefix = "parameter_";

/// What one case of a study found. `columns` are its raw data, `summary` is its row of the summary: the
/// columns that the kind declares (`SummaryRow`), in their order. The row in a file has `case` and
/// `parameters` before them, and `verdict` and `reason` after.
struct CaseResult {
  std::string id;   ///< group name in the file, unique in the study: "<problem>-<method>", no '/'
  std::string key;  ///< SHA-256 of the resolved case: what makes it the same case in another run; empty if it
                    ///< could not be computed
  std::vector<Column> columns;
  std::vector<SummaryCell> summary;
  std::vector<SummaryCell> parameters{};  ///< of the point of a sweep
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
void replace_cell(CaseResult& result, std::string_view name, CellValue value);

/// How a row differs from the declared columns, "cell 2 is \"x\" [s], expected \"y\" [1]"; nothing where it
/// does not.
std::string row_mismatch(const std::vector<SummaryColumn>& columns, const std::vector<SummaryCell>& row);

/// The row of a case that could not be computed: the cells that are known all the same (name and value), NaN,
/// `missing_integer` and empty texts for the others. A known cell has to be a column of the same type; throws
/// std::logic_error where it is none.
std::vector<SummaryCell> missing_row(const std::vector<SummaryColumn>& columns,
                                     const std::vector<std::pair<std::string, CellValue>>& known);

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
