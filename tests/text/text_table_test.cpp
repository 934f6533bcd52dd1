#include "text/text_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <sstream>

#include "text/utf8.hpp"
#include "text/wrapped_lines.hpp"

namespace fw::text {
namespace {

using Align = TextTable::Align;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::size_t longest_line(const std::string& text) {
  std::size_t longest = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) longest = std::max(longest, displayed_width(line));
  return longest;
}

/// Without blanks, rules and what the forms add: what a reader can find in it.
std::string letters_of(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c != ' ' && c != '\n' && c != '-' && c != '=') out += c;
  }
  std::ranges::sort(out);
  return out;
}

TEST(WrappedLines, BreakAtBlanksAndKeepWideGapsInside) {
  EXPECT_THAT(wrapped_lines("one two  three", 20), ElementsAre("one two  three"));
  EXPECT_THAT(wrapped_lines("one two  three", 9), ElementsAre("one two", "three"));
  EXPECT_THAT(wrapped_lines("", 9), ElementsAre(""));
  EXPECT_THAT(wrapped_lines("  ", 9), ElementsAre(""));
}

TEST(WrappedLines, BreakLongWordsAfterASeparatorElseAnywhereAndNeverInsideAnUmlaut) {
  EXPECT_THAT(wrapped_lines("order_low_position", 8), ElementsAre("order_", "low_", "position"));
  EXPECT_THAT(wrapped_lines("aäöüaäöü", 3), ElementsAre("aäö", "üaä", "öü"));
}

TEST(WrappedParagraph, StartsBesideItsHeadAndIsIndented) {
  EXPECT_EQ(wrapped_paragraph("  kind  ", "a b c d e f", 12, 8), "  kind  a b\n        c d\n        e f\n");
  EXPECT_EQ(wrapped_paragraph("x ", "a b", 0, 8), "x a b\n");
  EXPECT_EQ(wrapped_paragraph("a/very/long/path ", "word", 12, 4), "a/very/long/path\n    word\n");
}

TextTable sample() {
  TextTable table;
  table.add_column("method", Align::left, {"rk4", "velocity_verlet"});
  table.add_column("expected_order", Align::right, {"4", "2"});
  table.add_column("reason", Align::left,
                   {"position 4.001 and velocity 3.999", "it is as the theory predicts"});
  return table;
}

TEST(TextTable, WrapsTextAndHeadsInTheirColumns) {
  EXPECT_EQ(sample().text(64),
            "method           expected_order  reason\n"
            "---------------  --------------  -------------------------------\n"
            "rk4                           4  position 4.001 and velocity\n"
            "                                 3.999\n"
            "velocity_verlet               2  it is as the theory predicts\n");
}

TEST(TextTable, PutsALastColumnOfTextOnLinesOfItsOwn) {
  EXPECT_EQ(sample().text(32),
            "method           expected_order\n"
            "    reason\n"
            "---------------  --------------\n"
            "rk4                           4\n"
            "    position 4.001 and velocity\n"
            "    3.999\n"
            "velocity_verlet               2\n"
            "    it is as the theory predicts\n");
}

TEST(TextTable, WritesRowsAsParagraphsWhereColumnsDoNotFit) {
  TextTable table;
  table.add_column("case", Align::left, {"a", "b"});
  table.add_column("first_number", Align::right, {"1.23456e-05", ""});
  table.add_column("second_number", Align::right, {"6.54321e-05", "7.5"});
  table.add_column("unknown", Align::right, {"nan", "nan"});
  table.add_column("reason", Align::left, {"none", "one"});
  EXPECT_EQ(table.text(24),
            "case = a\n"
            "    first_number =\n"
            "    1.23456e-05\n"
            "    second_number =\n"
            "    6.54321e-05\n"
            "    reason = none\n"
            "\n"
            "case = b\n"
            "    second_number = 7.5\n"
            "    reason = one\n");
}

TEST(TextTable, LosesNothingAndFitsWhateverTheWidth) {
  std::mt19937 random(20261128);
  const auto up_to = [&](std::size_t most) {
    return std::uniform_int_distribution<std::size_t>(0, most)(random);
  };
  for (int trial = 0; trial < 300; ++trial) {
    TextTable table;
    std::string content;
    const std::size_t columns = 1 + up_to(14), rows = 1 + up_to(4);
    for (std::size_t i = 0; i < columns; ++i) {
      const bool is_number = up_to(2) > 0;
      std::vector<std::string> cells;
      for (std::size_t k = 0; k < rows; ++k) {
        std::string cell;
        for (std::size_t n = is_number ? 1 : up_to(6); n > 0; --n) {
          cell += (cell.empty() ? "" : " ") + std::string(1 + up_to(n % 3 == 0 ? 30 : 8), 'a') + "ü";
        }
        content += cell;
        cells.push_back(cell);
      }
      table.add_column(std::string(1 + up_to(12), 'h') + "_" + std::string(1 + up_to(8), 'h'),
                       is_number ? Align::right : Align::left, cells);
    }
    for (const std::size_t width : {20, 40, 80, 200}) {
      const std::string text = table.text(width);
      ASSERT_LE(longest_line(text), width) << text;
      std::string found = letters_of(text);
      std::erase_if(found, [](char c) { return c == 'h' || c == '_'; });
      ASSERT_EQ(found, letters_of(content)) << width << "\n" << text;
    }
  }
}

}  // namespace
}  // namespace fw::text
