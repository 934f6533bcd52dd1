#include "text/wrapped_lines.hpp"

#include <algorithm>

#include "text/utf8.hpp"

namespace fw::text {

namespace {

/// Number of bytes of the first `count` code points.
std::size_t bytes_of(std::string_view text, std::size_t count) {
  std::size_t at = 0;
  for (; at < text.size(); ++at) {
    const bool starts_code_point = (static_cast<unsigned char>(text[at]) & 0xc0U) != 0x80U;
    if (starts_code_point && count-- == 0) break;
  }
  return at;
}

/// How many bytes of a word that is longer than `width` go on a line.
std::size_t break_of(std::string_view word, std::size_t width) {
  const std::size_t most = bytes_of(word, width);
  const std::size_t separator = word.substr(0, most).find_last_of("_-/,;:=[");
  // A break near the start of the word would waste the line.
  return separator != std::string_view::npos && 2 * (separator + 1) >= most ? separator + 1 : most;
}

}  // namespace

std::vector<std::string> wrapped_lines(std::string_view text, std::size_t width) {
  width = std::max<std::size_t>(width, 1);
  std::vector<std::string> lines(1);
  std::size_t used = 0;  // code points of the last line
  while (true) {
    const std::size_t start = text.find_first_not_of(' ');
    if (start == std::string_view::npos) return lines;
    // Blanks inside a line are kept: they set things apart.
    const std::size_t gap = lines.back().empty() ? 0 : start;
    text.remove_prefix(start);
    std::string_view word = text.substr(0, text.find(' '));
    const std::size_t length = displayed_width(word);
    if (used + gap + length <= width) {
      lines.back().append(gap, ' ').append(word);
      used += gap + length;
    } else {
      if (!lines.back().empty()) lines.emplace_back();
      if (length > width) word = word.substr(0, break_of(word, width));
      lines.back() = word;
      used = displayed_width(word);
      if (length > width) {
        lines.emplace_back();
        used = 0;
      }
    }
    text.remove_prefix(word.size());
  }
}

std::string wrapped_paragraph(const std::string& first, std::string_view text, std::size_t width,
                              std::size_t indent) {
  if (width == 0) return first + std::string(text) + '\n';
  const std::size_t start = displayed_width(first);
  text.remove_prefix(std::min(text.size(), text.find_first_not_of(' ')));
  std::string out = first, rest(text);
  // The first line has another width than the others: what it holds is what fits beside `first`.
  if (start < width) {
    const std::vector<std::string> lines = wrapped_lines(rest, width - start);
    // A break inside a word for lack of place on the first line helps nobody where the next has more of it.
    const std::string& line = lines.front();
    const bool breaks_word = line.size() < rest.size() && rest[line.size()] != ' ' && indent < start;
    if (!breaks_word) {
      out += line;
      rest.erase(0, std::min(rest.size(), rest.find_first_not_of(' ', line.size())));
    }
  }
  out.erase(out.find_last_not_of(' ') + 1);
  out += '\n';
  if (rest.empty()) return out;
  const std::size_t room = width > indent ? width - indent : 1;
  for (const std::string& line : wrapped_lines(rest, room)) out += std::string(indent, ' ') + line + '\n';
  return out;
}

}  // namespace fw::text
