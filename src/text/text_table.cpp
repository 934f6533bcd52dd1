#include "text/text_table.hpp"

#include <algorithm>
#include <numeric>

#include "text/utf8.hpp"
#include "text/wrapped_lines.hpp"

namespace fw::text {

namespace {

constexpr std::size_t gap = 2;  ///< blanks between columns

/// Text is not wrapped to less than this; prose not to less than the other, it rather gets lines of its own.
constexpr std::size_t narrowest_text = 12, narrowest_prose = 28;

constexpr std::size_t notes_indent = 4;  ///< of a column that has lines of its own

std::size_t total(const std::vector<std::size_t>& widths) {
  if (widths.empty()) return 0;
  return std::accumulate(widths.begin(), widths.end(), gap * (widths.size() - 1));
}

std::size_t longest_word(const std::string& text) {
  std::size_t longest = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    longest = std::max(longest, displayed_width(std::string_view(text).substr(at, end - at)));
    at = end + 1;
  }
  return longest;
}

/// The longest part of a head, which breaks at blanks and after underlines.
std::size_t longest_part(const std::string& head) {
  std::size_t longest = 0, part = 0;
  for (const char letter : head) {
    if (letter == ' ') {
      part = 0;
      continue;
    }
    if ((static_cast<unsigned char>(letter) & 0xc0U) != 0x80U) longest = std::max(longest, ++part);
    if (letter == '_') part = 0;
  }
  return longest;
}

/// Takes width from the widest columns that have more than their least, until the table fits.
void shrink(std::vector<std::size_t>& widths, const std::vector<std::size_t>& least, std::size_t width) {
  for (std::size_t sum = total(widths); sum > width; --sum) {
    std::size_t widest = widths.size();
    for (std::size_t i = 0; i < widths.size(); ++i) {
      if (widths[i] > least[i] && (widest == widths.size() || widths[i] > widths[widest])) widest = i;
    }
    if (widest == widths.size()) return;
    widths[widest] -= 1;
  }
}

}  // namespace

void TextTable::add_column(std::string head, Align align, std::vector<std::string> cells) {
  head = printable_line(head);
  for (std::string& cell : cells) cell = printable_line(cell);
  columns_.push_back({std::move(head), align, std::move(cells)});
}

std::size_t TextTable::rows() const {
  std::size_t most = 0;
  for (const Column& column : columns_) most = std::max(most, column.cells.size());
  return most;
}

std::vector<std::size_t> TextTable::natural_widths() const {
  std::vector<std::size_t> widths;
  for (const Column& column : columns_) {
    std::size_t width = displayed_width(column.head);
    for (const std::string& cell : column.cells) width = std::max(width, displayed_width(cell));
    widths.push_back(width);
  }
  return widths;
}

/// Numbers are not wrapped, and names that fit the narrowest text neither.
std::vector<std::size_t> TextTable::least_widths() const {
  std::vector<std::size_t> widths;
  for (const Column& column : columns_) {
    std::size_t width = longest_part(column.head);
    for (const std::string& cell : column.cells) {
      const bool is_text = column.align == Align::left;
      width = std::max(width, is_text ? std::min(longest_word(cell), narrowest_text) : displayed_width(cell));
    }
    widths.push_back(width);
  }
  return widths;
}

std::string TextTable::text(std::size_t width) const {
  std::vector<std::size_t> widths = natural_widths();
  if (width == 0 || total(widths) <= width) return aligned(widths, 0);
  std::vector<std::size_t> least = least_widths();
  const bool has_prose = columns_.size() > 1 && columns_.back().align == Align::left;
  if (has_prose) least.back() = std::max(least.back(), std::min(widths.back(), narrowest_prose));
  if (total(least) <= width) {
    shrink(widths, least, width);
    return aligned(widths, 0);
  }
  if (has_prose) {
    least.pop_back();
    widths.pop_back();
    if (total(least) <= width) {
      shrink(widths, least, width);
      return aligned(widths, width);
    }
  }
  return paragraphs(width);
}

/// Columns without a width are printed under their row, wrapped to `notes_width`.
std::string TextTable::aligned(const std::vector<std::size_t>& widths, std::size_t notes_width) const {
  std::string out;
  const auto add_row = [&](const auto& cell_of) {
    std::vector<std::vector<std::string>> cells;
    std::size_t height = 1;
    for (std::size_t i = 0; i < widths.size(); ++i) {
      cells.push_back(wrapped_lines(cell_of(columns_[i]), widths[i]));
      // What is as wide as its column is not to be touched, whatever blanks it has.
      if (displayed_width(cell_of(columns_[i])) <= widths[i]) cells.back() = {cell_of(columns_[i])};
      height = std::max(height, cells.back().size());
    }
    for (std::size_t k = 0; k < height; ++k) {
      std::string line;
      for (std::size_t i = 0; i < widths.size(); ++i) {
        const std::string cell = k < cells[i].size() ? cells[i][k] : std::string();
        const std::string blanks(widths[i] - displayed_width(cell), ' ');
        if (i > 0) line.append(gap, ' ');
        line += columns_[i].align == Align::right ? blanks + cell : cell + blanks;
      }
      line.erase(line.find_last_not_of(' ') + 1);
      out += line + '\n';
    }
    for (std::size_t i = widths.size(); i < columns_.size(); ++i) {
      const std::string note = cell_of(columns_[i]);
      if (note.empty()) continue;
      const std::string indent(notes_indent, ' ');
      out += wrapped_paragraph(indent, note, notes_width, notes_indent);
    }
  };
  add_row([](const Column& column) { return column.head; });
  for (std::size_t i = 0; i < widths.size(); ++i) {
    out += (i > 0 ? std::string(gap, ' ') : std::string()) + std::string(widths[i], '-');
  }
  out += '\n';
  for (std::size_t row = 0; row < rows(); ++row) {
    add_row([row](const Column& column) {
      return row < column.cells.size() ? column.cells[row] : std::string();
    });
  }
  return out;
}

std::string TextTable::paragraphs(std::size_t width) const {
  std::string out;
  for (std::size_t row = 0; row < rows(); ++row) {
    if (row > 0) out += '\n';
    std::string line;
    const auto end_line = [&] {
      if (!line.empty()) out += line + '\n';
      line.clear();
    };
    bool is_first = true;
    for (const Column& column : columns_) {
      if (row >= column.cells.size() || column.cells[row].empty()) continue;
      if (column.align == Align::right && column.cells[row] == "nan") continue;
      const std::string pair = column.head + (column.head.empty() ? "" : " = ") + column.cells[row];
      const bool is_prose = &column == &columns_.back() && column.align == Align::left;
      const std::size_t used = displayed_width(line), needed = displayed_width(pair);
      if (!line.empty() && !is_prose && used + gap + needed <= width) {
        line += std::string(gap, ' ') + pair;
        continue;
      }
      end_line();
      const std::string indent(is_first ? 0 : notes_indent, ' ');
      is_first = false;
      if (indent.size() + needed <= width) {
        line = indent + pair;
      } else {
        out += wrapped_paragraph(indent, pair, width, notes_indent);
      }
    }
    end_line();
  }
  return out;
}

}  // namespace fw::text
