#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "study/result.hpp"

namespace fw::store {

/// How a table is written for other programs and papers.
enum class TableFormat {
  csv,       ///< RFC 4180, numbers with all digits
  markdown,  ///< pipes, as on GitHub; numbers with six digits
  latex,     ///< `tabular` with the rules of the package booktabs; numbers with four digits, powers of ten as
             ///< such
};

/// Which table of a result file, and what of it.
struct TableChoice {
  TableFormat format = TableFormat::csv;
  std::string of_case;  ///< id of a case, for its raw columns; empty: the summary, or a trajectory's frames
  std::vector<std::string>
      columns{};  ///< names, in this order; empty: all (of Markdown and LaTeX: without `reason`)
};

/// The table as text. Columns of a case are those with one dimension, shorter ones are filled with blanks; of
/// a trajectory time, energies and the components of both momenta. Units stand in brackets behind the names.
/// Throws InputError that names the file for a case or column that is not there, with those that are.
std::string show_table(const std::filesystem::path& path, const TableChoice& choice);

/// Those of the columns that are named, in that order. Throws InputError that names the file and what is
/// there.
std::vector<record::Column> pick_columns(const std::vector<record::Column>& columns,
                                         const std::vector<std::string>& names, const std::string& file);

}  // namespace fw::store
