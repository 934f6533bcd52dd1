#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace fw::text {

/// `text` as lines of at most `width` ≥ 1 code points, broken at blanks; a word that is longer is broken after a
/// separator (one of _ - / , ; : = [) where it has one, else anywhere. Blanks at breaks are dropped. Never empty.
std::vector<std::string> wrapped_lines(std::string_view text, std::size_t width);

/// `first` followed by `text`, wrapped to `width`; lines after the first are indented by `indent` blanks. Each
/// line ends with a newline. With 0 for `width` there is one line.
std::string wrapped_paragraph(const std::string& first, std::string_view text, std::size_t width,
                              std::size_t indent);

}  // namespace fw::text
