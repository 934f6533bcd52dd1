#include "system/terminal.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <string_view>

namespace fw {

bool is_terminal(int descriptor) {
  return ::isatty(descriptor) == 1;
}

std::size_t terminal_width(int descriptor) {
  if (!is_terminal(descriptor)) return default_terminal_width;
  std::size_t width = 0;
  winsize size{};
  if (::ioctl(descriptor, TIOCGWINSZ, &size) == 0) width = size.ws_col;
  if (const char* variable = std::getenv("COLUMNS"); width == 0 && variable != nullptr) {
    const std::string_view text = variable;
    std::from_chars(text.data(), text.data() + text.size(), width);
  }
  constexpr std::size_t widest = 1000;  // of what a variable may claim
  return std::clamp(width, default_terminal_width, widest);
}

}  // namespace fw
