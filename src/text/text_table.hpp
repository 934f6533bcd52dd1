#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace fw::text {

/// A table for a terminal: columns aligned, numbers to the right, text to the left, a rule under the heads.
///
/// A table that is wider than it may be changes its form, the first of these that fits: text is wrapped inside
/// its column (and heads at their blanks and underlines); the last column, if it is text, goes to lines of its
/// own under each row; each row is a paragraph of `head = value`, without its empty cells and
/// numbers that are none (nan).
class TextTable {
 public:
  enum class Align { left, right };

  void add_column(std::string head, Align align, std::vector<std::string> cells);
  bool empty() const { return columns_.empty(); }

  /// The lines, each ended by a newline and without blanks at its end; none is longer than `width` code points.
  /// With 0 a line is as long as it has to be.
  std::string text(std::size_t width = 0) const;

 private:
  struct Column {
    std::string head;
    Align align;
    std::vector<std::string> cells;
  };

  std::size_t rows() const;
  std::vector<std::size_t> natural_widths() const;
  std::vector<std::size_t> least_widths() const;
  std::string aligned(const std::vector<std::size_t>& widths, std::size_t notes_width) const;
  std::string paragraphs(std::size_t width) const;

  std::vector<Column> columns_;
};

}  // namespace fw::text
