#pragma once

#include <cstddef>

namespace fw {

/// Columns of a page of which nothing is known.
inline constexpr std::size_t default_terminal_width = 80;

/// Columns that tables on the file descriptor may use: those of the terminal, else those that the environment
/// variable COLUMNS gives, but at least `default_terminal_width`. What is no terminal (a file, a pipe) gets
/// `default_terminal_width` whatever the variable says, so that files do not depend on the window.
std::size_t terminal_width(int descriptor);

/// Whether the file descriptor is a terminal.
bool is_terminal(int descriptor);

}  // namespace fw
