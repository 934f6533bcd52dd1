#pragma once

#include <string>
#include <string_view>

namespace fw::text {

/// `text` with every byte that is not part of a valid UTF-8 sequence replaced by U+FFFD [RFC 3629].
std::string valid_utf8(std::string_view text);

/// `text` as one line that is safe for a terminal: valid UTF-8, control characters replaced by spaces.
std::string printable_line(std::string_view text);

/// Number of code points, an estimate of the columns that a terminal needs.
std::size_t displayed_width(std::string_view text);

}  // namespace fw::text
