#include "text/text_table.hpp"

#include <algorithm>

#include "text/utf8.hpp"

namespace fw::text {

void TextTable::add_column(std::string head, Align align, std::vector<std::string> cells) {
  head = printable_line(head);
  for (std::string& cell : cells) cell = printable_line(cell);
  columns_.push_back({std::move(head), align, std::move(cells)});
}

std::string TextTable::text() const {
  std::size_t rows = 0;
  std::vector<std::size_t> widths;
  for (const Column& column : columns_) {
    std::size_t width = displayed_width(column.head);
    for (const std::string& cell : column.cells) width = std::max(width, displayed_width(cell));
    widths.push_back(width);
    rows = std::max(rows, column.cells.size());
  }
  std::string out, line;
  const auto add = [&](std::size_t i, const std::string& cell) {
    if (i > 0) line += "  ";
    const std::string blanks(widths[i] - displayed_width(cell), ' ');
    line += columns_[i].align == Align::right ? blanks + cell : cell + blanks;
  };
  const auto end_line = [&] {
    line.erase(line.find_last_not_of(' ') + 1);
    out += line + '\n';
    line.clear();
  };
  for (std::size_t i = 0; i < columns_.size(); ++i) add(i, columns_[i].head);
  end_line();
  for (std::size_t i = 0; i < columns_.size(); ++i) add(i, std::string(widths[i], '-'));
  end_line();
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      add(i, row < columns_[i].cells.size() ? columns_[i].cells[row] : std::string());
    }
    end_line();
  }
  return out;
}

}  // namespace fw::text
