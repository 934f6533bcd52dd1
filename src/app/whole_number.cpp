#include <fmt/format.h>

#include <charconv>
#include <cstdint>

#include "app/commands.hpp"

namespace fw::app {

CLI::Validator whole_number() {
  return CLI::Validator(
      [](const std::string& text) -> std::string {
        std::int64_t value = 0;
        const char* end = text.data() + text.size();
        const auto [stop, error] = std::from_chars(text.data(), end, value);
        if (error == std::errc() && stop == end) return "";
        const char* expected =
            error == std::errc::result_out_of_range ? "an integer below 2^63 in size" : "an integer";
        return fmt::format("found {}, expected {}", text, expected);
      },
      "");
}

}  // namespace fw::app
