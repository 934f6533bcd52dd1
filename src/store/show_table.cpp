#include "store/show_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "store/case_groups.hpp"
#include "store/hdf5/attribute.hpp"
#include "store/hdf5/dataset.hpp"
#include "store/input_file.hpp"
#include "study/result.hpp"
#include "text/closest_name.hpp"
#include "text/utf8.hpp"

namespace fw::store {

namespace {

using record::Column;

/// A column whose cells are text already.
struct TextColumn {
  std::string head;
  bool is_text = false;
  std::vector<std::string> cells;
};

/// Entry `component` of each row of an (F, 3) array as a column of its own.
Column component_of(const Column& vectors, std::size_t component) {
  static constexpr const char* axes[] = {"_x", "_y", "_z"};
  const auto& values = std::get<std::vector<double>>(vectors.values);
  std::vector<double> entries;
  for (std::size_t k = component; k < values.size(); k += 3) entries.push_back(values[k]);
  return {vectors.name + axes[component], vectors.unit, std::move(entries), {}, {}};
}

/// Time, energies and momenta of the frames: positions and velocities of all particles are no table.
std::vector<Column> frames_of(hid_t file) {
  std::vector<Column> columns;
  const Handle group = open_group(file, "trajectory");
  for (const std::string& name : link_names(group)) {
    if (name == "position" || name == "velocity") continue;
    Column column = read_dataset(group, name);
    if (column.shape.size() == 2) {
      for (std::size_t axis = 0; axis < 3; ++axis) columns.push_back(component_of(column, axis));
    } else {
      columns.push_back(std::move(column));
    }
  }
  return columns;
}

std::vector<Column> columns_of_case(hid_t file, const std::string& id) {
  const Handle cases = open_group(file, "cases");
  const std::vector<std::string> ids = link_names(cases);
  if (std::find(ids.begin(), ids.end(), id) == ids.end()) {
    throw InputError(fmt::format("found no case \"{}\"{}", id, did_you_mean(id, ids)));
  }
  const Handle group = open_group(cases, id);
  std::vector<Column> columns;
  for (const std::string& name : link_names(group)) {
    Column column = read_dataset(group, name);
    if (column.shape.size() <= 1) columns.push_back(std::move(column));
  }
  return columns;
}

std::vector<Column> read_table(const std::filesystem::path& path, const TableChoice& choice) {
  const LibraryLock lock;
  const InputFile file(path);
  try {
    if (!choice.of_case.empty()) {
      if (!has_link(file.id(), "cases")) throw InputError("a trajectory has no cases");
      return columns_of_case(file.id(), choice.of_case);
    }
    return has_link(file.id(), "trajectory") ? frames_of(file.id()) : read_summary(file.id());
  } catch (const LibraryError& error) {
    throw InputError(fmt::format("\"{}\" is damaged: {}", path.string(), error.what()));
  } catch (const InputError& error) {
    throw InputError(fmt::format("\"{}\": {}", path.string(), error.what()));
  }
}

std::vector<Column> chosen(std::vector<Column> columns, const TableChoice& choice, const std::string& file) {
  if (!choice.columns.empty()) return pick_columns(columns, choice.columns, file);
  if (choice.format != TableFormat::csv) {
    std::erase_if(columns, [](const Column& column) { return column.name == "reason"; });
  }
  return columns;
}

std::string escaped_for_latex(const std::string& text) {
  std::string out;
  for (const char letter : text) {
    switch (letter) {
      case '\\':
        out += "\\textbackslash{}";
        break;
      case '~':
        out += "\\textasciitilde{}";
        break;
      case '^':
        out += "\\textasciicircum{}";
        break;
      case '&':
      case '%':
      case '$':
      case '#':
      case '_':
      case '{':
      case '}':
        out += '\\';
        [[fallthrough]];
      default:
        out += letter;
    }
  }
  return out;
}

/// "$1.234 \cdot 10^{-5}$", "0.5", "--" for NaN.
std::string number_for_latex(double value) {
  if (std::isnan(value)) return "--";
  if (std::isinf(value)) return value > 0 ? "$\\infty$" : "$-\\infty$";
  const std::string text = fmt::format("{:.4g}", value);
  const std::size_t e = text.find('e');
  if (e == text.npos) return text.starts_with('-') ? fmt::format("${}$", text) : text;
  return fmt::format("${} \\cdot 10^{{{}}}$", text.substr(0, e), std::stoi(text.substr(e + 1)));
}

std::string cell_text(double value, TableFormat format) {
  if (format == TableFormat::latex) return number_for_latex(value);
  return format == TableFormat::csv ? fmt::format("{}", value) : fmt::format("{:.6g}", value);
}

std::string cell_text(std::int64_t value, TableFormat) {
  return fmt::format("{}", value);
}

std::string cell_text(const std::string& value, TableFormat format) {
  if (format == TableFormat::csv) {
    if (value.find_first_of(",\"\r\n") == value.npos) return value;
    std::string quoted = "\"";
    for (const char letter : value) quoted += letter == '"' ? std::string("\"\"") : std::string(1, letter);
    return quoted + '"';
  }
  if (format == TableFormat::latex) return escaped_for_latex(text::printable_line(value));
  std::string piped;
  for (const char letter : text::printable_line(value))
    piped += letter == '|' ? std::string("\\|") : std::string(1, letter);
  return piped;
}

TextColumn text_of(const Column& column, TableFormat format) {
  const bool has_unit = !column.unit.empty() && column.unit != "1";
  TextColumn text;
  text.head = cell_text(has_unit ? fmt::format("{} [{}]", column.name, column.unit) : column.name, format);
  text.is_text = std::holds_alternative<std::vector<std::string>>(column.values);
  std::visit(
      [&](const auto& values) {
        for (const auto& value : values) {
          text.cells.push_back(column.lacks(value) ? std::string() : cell_text(value, format));
        }
      },
      column.values);
  return text;
}

std::string joined(const std::vector<std::string>& cells, std::string_view start, std::string_view between,
                   std::string_view end) {
  return fmt::format("{}{}{}\n", start, fmt::join(cells, between), end);
}

}  // namespace

std::vector<Column> pick_columns(const std::vector<Column>& columns, const std::vector<std::string>& names,
                                 const std::string& file) {
  std::vector<std::string> present;
  present.reserve(columns.size());
  for (const Column& column : columns) present.push_back(column.name);
  std::vector<Column> picked;
  for (const std::string& name : names) {
    const auto found = std::find(present.begin(), present.end(), name);
    if (found == present.end()) {
      throw InputError(fmt::format("\"{}\": found no column \"{}\"{}; there are {}", file, name,
                                   did_you_mean(name, present), fmt::join(present, ", ")));
    }
    picked.push_back(columns[static_cast<std::size_t>(found - present.begin())]);
  }
  return picked;
}

std::string show_table(const std::filesystem::path& path, const TableChoice& choice) {
  std::vector<TextColumn> columns;
  std::size_t rows = 0;
  for (const Column& column : chosen(read_table(path, choice), choice, path.string())) {
    columns.push_back(text_of(column, choice.format));
    rows = std::max(rows, columns.back().cells.size());
  }
  const auto cells_of = [&](auto cell) {
    std::vector<std::string> cells;
    for (const TextColumn& column : columns) cells.push_back(cell(column));
    return cells;
  };
  const auto line = [&](const std::vector<std::string>& cells) {
    if (choice.format == TableFormat::csv) return joined(cells, "", ",", "");
    if (choice.format == TableFormat::markdown) return joined(cells, "| ", " | ", " |");
    return joined(cells, "  ", " & ", " \\\\");
  };
  std::string out;
  const std::vector<std::string> heads = cells_of([](const TextColumn& column) { return column.head; });
  if (choice.format == TableFormat::latex) {
    const std::vector<std::string> places =
        cells_of([](const TextColumn& column) { return std::string(column.is_text ? "l" : "r"); });
    out += joined(places, "\\begin{tabular}{", "", "}") + "  \\toprule\n";
  }
  out += line(heads);
  if (choice.format == TableFormat::markdown) {
    out += joined(
        cells_of([](const TextColumn& column) { return std::string(column.is_text ? "---" : "---:"); }), "|",
        "|", "|");
  }
  if (choice.format == TableFormat::latex) out += "  \\midrule\n";
  for (std::size_t row = 0; row < rows; ++row) {
    out += line(cells_of([row](const TextColumn& column) {
      return row < column.cells.size() ? column.cells[row] : std::string();
    }));
  }
  if (choice.format == TableFormat::latex) out += "  \\bottomrule\n\\end{tabular}\n";
  return out;
}

}  // namespace fw::store
