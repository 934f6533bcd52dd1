#pragma once

#include <string>
#include <vector>

namespace fw::text {

/// A table for a terminal: columns aligned, numbers to the right, text to the left, a rule under the heads.
class TextTable {
 public:
  enum class Align { left, right };

  void add_column(std::string head, Align align, std::vector<std::string> cells);
  bool empty() const { return columns_.empty(); }

  /// The lines, each ended by a newline and without blanks at its end.
  std::string text() const;

 private:
  struct Column {
    std::string head;
    Align align;
    std::vector<std::string> cells;
  };
  std::vector<Column> columns_;
};

}  // namespace fw::text
